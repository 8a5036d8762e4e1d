"""What a range took where it reaches beyond its source, and how long that really is."""

from pathlib import Path

import media_samples as samples
import pytest

from pipeline.cli import main
from stages.media import FrameRange, open_decoder, probe
from stages.media.writing.encoder_setup import EncodeOptions
from stages.media.writing.output_plan import check_output
from warp_kernels.errors import OptionError

QUICK = ["--triangles", "20", "--iterations", "2"]


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """Six frames of a quarter of a second."""
    frames = [samples.picture(64, 48, seed) for seed in range(6)]
    return samples.write_video(tmp_path / "in.mp4", frames, pts=[3200 * k for k in range(6)])


def notes_of(path: Path, text: str) -> list[str]:
    """Notes on a range once all of it was read."""
    with open_decoder(path, FrameRange.parse(text)) as decoder:
        assert len(list(decoder)) > 0
        return [note for note in decoder.notes if note.startswith("frames")]


@pytest.mark.parametrize("text", ["0-5", "0-", "2-4", "5", "0-4x2"])
def test_range_within_is_not_told(clip: Path, text: str) -> None:
    """What was asked for is what is there."""
    assert notes_of(clip, text) == []


@pytest.mark.parametrize("text", ["4-100", "0-6", "0-50x2"])
def test_range_beyond_is_told(clip: Path, text: str, tmp_path: Path) -> None:
    """With the number of the last frame; numbered stills as well."""
    expected = [f"frames {text}: the source ends with frame 5"]
    assert notes_of(clip, text) == expected
    for number in range(6):
        samples.write_still(tmp_path / f"s_{number:02}.png", samples.picture(16, 8, number))
    assert notes_of(tmp_path / "s_##.png", text) == expected


@pytest.mark.parametrize(("frames", "start"), [("0-2", "1"), ("0-2", "99"), ("8-9", "0")])
def test_range_without_a_frame_tells_the_true_length(clip: Path, frames: str, start: str) -> None:
    """However early the decoder could stop."""
    wanted = FrameRange.parse(frames, start)
    with open_decoder(clip, wanted) as decoder, pytest.raises(OptionError, match="frames 0 to 5"):
        next(decoder)


def test_note_survives_solving_and_drawing(clip: Path, tmp_path: Path, capsys) -> None:
    """Of `animate`, in one process and in several, and of `render` about the track."""
    out, track = str(tmp_path / "o.mp4"), str(tmp_path / "a.mtrk")
    more = ["--frames", "4-100", "--overwrite", *QUICK]
    assert main(["animate", str(clip), "-o", out, *more, "--track", track]) == 0
    assert capsys.readouterr().err.count("frames 4-100: the source ends with frame 5") == 1
    assert main(["animate", str(clip), "-o", out, *more, "--jobs", "2"]) == 0
    assert capsys.readouterr().err.count("frames 4-100: the source ends with frame 5") == 1
    assert main(["render", track, "-o", out, "--overwrite", "--frames", "5-9"]) == 0
    assert "frames 5-9: the track ends with frame 5" in capsys.readouterr().err


def test_one_still_of_several_frames_counts_them(clip: Path, tmp_path: Path) -> None:
    """Those that are asked for, not those of the clip."""
    with pytest.raises(OptionError, match="cannot hold 3 frames"):
        check_output(
            tmp_path / "k.png", probe(clip), (64, 48), EncodeOptions(), FrameRange.parse("0-2")
        )


def test_joining_tells_that_it_is_done(clip: Path, tmp_path: Path, capsys) -> None:
    """On standard error, unless it shall be quiet."""
    parts = [str(tmp_path / name) for name in ("a.mtrk", "b.mtrk")]
    for part, frames in zip(parts, ("0-2", "3-5"), strict=True):
        assert main(["solve", str(clip), "-o", part, "--frames", frames, *QUICK, "-q"]) == 0
    capsys.readouterr()
    whole = str(tmp_path / "whole.mtrk")
    assert main(["join", *parts, "-o", whole]) == 0
    captured = capsys.readouterr()
    assert captured.err == f"2 tracks joined, frames 0 to 5, 6 in all: {whole}\n"
    assert captured.out == ""
    assert main(["join", *parts, "-o", whole, "--overwrite", "-q"]) == 0
    assert capsys.readouterr().err == ""
