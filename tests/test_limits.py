"""`--limits`: how much of a file is believed."""

import json
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from pipeline.cli import main
from stages.media import open_decoder, probe
from stages.media.reading.limits import HIGHEST, Limits
from stages.media.reading.read_options import ReadOptions
from tests import media_samples as samples
from tests.tracks import COUNT, QUICK_FLAGS, write_clip
from warp_kernels.errors import MediaError, OptionError


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """96 x 64 pixels, twelve frames, two streams."""
    return write_clip(tmp_path_factory.mktemp("limits") / "clip.mp4")


@pytest.mark.parametrize(
    ("limit", "words"),
    [
        ("pixels=6143", "more than 0 million; scale it down"),
        ("frames=11", f"{COUNT} frames, more than 11; take a part by --frames A-B, or raise"),
        ("streams=1", "has more than 1 streams; raise"),
    ],
)
def test_what_is_beyond_a_limit_is_refused(
    limit: str, words: str, clip: Path, tmp_path: Path, capsys
) -> None:
    """One line that names the option, and nothing is written; at the limit all is well."""
    name = limit.split("=")[0]
    flags = ("-o", str(tmp_path / "o.mp4"), "-q", *QUICK_FLAGS, "--limits", limit)
    assert main(["animate", str(clip), *flags]) == 3
    error = capsys.readouterr().err
    assert words in error
    assert f"--limits {name}=N" in error
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())
    enough = f"{name}={int(limit.split('=')[1]) + 1}"
    with open_decoder(clip, read=ReadOptions(limits=enough)) as decoder:
        assert len(list(decoder)) == COUNT


def test_a_part_within_the_limit_is_read(clip: Path, tmp_path: Path) -> None:
    """The limit counts what is converted, not what is there; stills are counted alike."""
    flags = ("-o", str(tmp_path / "o.png"), "-q", *QUICK_FLAGS, "--limits", "frames=1")
    assert main(["animate", str(clip), *flags, "--frames", "8"]) == 0
    for number in range(3):
        samples.write_still(tmp_path / f"s_{number:02d}.png", samples.picture(32, 24))
    with pytest.raises(MediaError, match="3 frames, more than 2"):
        open_decoder(tmp_path / "s_##.png", read=ReadOptions(limits="frames=2"))


def test_a_film_that_does_not_tell_its_length_ends_at_the_limit(tmp_path: Path) -> None:
    """With a warning: what came before is no worse for it."""
    frames = [samples.picture(32, 24, number) for number in range(9)]
    path = samples.write_video(tmp_path / "clip.h264", frames)
    assert probe(path).frame_count is None
    with open_decoder(path, read=ReadOptions(limits="frames=4")) as decoder:
        assert [frame.index for frame in decoder] == [0, 1, 2, 3]
    assert any("--limits frames=N" in text for text in decoder.warnings)
    with open_decoder(path, read=ReadOptions(limits="frames=9")) as decoder:
        assert len(list(decoder)) == 9
    assert not decoder.warnings


def test_frames_that_are_only_stated_do_not_count(tmp_path: Path) -> None:
    """AVI may state many times what it holds."""
    frames = [samples.picture(32, 24, number) for number in range(9)]
    path = samples.write_video(tmp_path / "clip.avi", frames)
    stated = probe(path).frame_count
    assert stated is not None
    assert stated > 9
    with open_decoder(path, read=ReadOptions(limits="frames=9")) as decoder:
        assert len(list(decoder)) == 9
    with pytest.raises(MediaError, match="9 frames, more than 8"):
        open_decoder(path, read=ReadOptions(limits="frames=8"))


@pytest.mark.parametrize(
    "text",
    [
        *("", "5", "pixels", "pixels=", "pixels=-1", "pixels=1e6", "bytes=5", "pixels=0"),
        *(
            "frames=٣",
            "pixels=5,pixels=6",
            f"pixels={HIGHEST['pixels'] + 1}",
            "streams=" + "9" * 40,
        ),
    ],
)
def test_odd_limits_are_refused(text: str) -> None:
    """In one line that says how they are written, or what they may be."""
    with pytest.raises(OptionError, match="--limits") as caught:
        ReadOptions(limits=text)
    assert "\n" not in str(caught.value)


def test_limits_are_read() -> None:
    """Some or all; the others keep their defaults."""
    assert ReadOptions().most == Limits()
    assert Limits.parse("frames=5, streams=7") == Limits(frames=5, streams=7)


def test_other_limits_go_on_with_a_track(clip: Path, tmp_path: Path) -> None:
    """They decide no mesh; tracks that know of none are as good."""
    track = tmp_path / "t.mtrk"
    solve = ["solve", str(clip), "-o", str(track), "-q", *QUICK_FLAGS]
    assert main([*solve, "--frames", "0-2"]) == 0
    assert main([*solve, "--frames", "0-3", "--resume", "--limits", "frames=90"]) == 0
    with closing(sqlite3.connect(track)) as connection:
        ((text,),) = connection.execute("SELECT value FROM header WHERE key = 'options'")
        options = json.loads(text)
        options["read"].pop("limits", None)
        update = "UPDATE header SET value = ? WHERE key = 'options'"
        connection.execute(update, (json.dumps(options),))
        connection.commit()
    assert main([*solve, "--frames", "0-4", "--resume", "--limits", "streams=9"]) == 0
