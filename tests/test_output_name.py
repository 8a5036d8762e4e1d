"""Folders, pipes and times as users write them."""

import os
import subprocess
import sys
from pathlib import Path

import media_samples as samples
import pytest
from test_encode import ROOT

from pipeline.cli import main
from pipeline.options.output_name import FILMS, STILLS, output_in
from stages.media import open_decoder, probe
from stages.media.naming import STILL_ENDINGS
from stages.media.writing.codecs import CONTAINERS

QUICK = ["--triangles", "20", "--iterations", "2", "--frame-iterations", "1", "--progress", "none"]


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """Six frames with sound."""
    pictures = [samples.picture(64, 48, n) for n in range(6)]
    return samples.write_video(tmp_path / "clip.avi.mp4", pictures, sound=1)


def test_endings_are_those_that_can_be_written() -> None:
    """The lists of the light module and of the encoder agree."""
    assert frozenset(CONTAINERS) == FILMS
    assert STILL_ENDINGS == STILLS


@pytest.mark.parametrize(
    ("source", "name"),
    [
        ("a/clip.mov", "clip.mov"),
        ("clip.AVI", "clip.mp4"),
        ("clip", "clip.mp4"),
        ("photo.heic", "photo.png"),
        ("photo.JPG", "photo.JPG"),
        ("s_####.png", "s_####.png"),
        ("loop.gif", "loop.gif"),
    ],
)
def test_a_folder_takes_the_name_of_the_input(tmp_path: Path, source: str, name: str) -> None:
    """With an ending that can be written."""
    assert output_in(tmp_path, source) == tmp_path / name
    assert output_in(f"{tmp_path}/", source) == tmp_path / name
    assert output_in(f"{tmp_path}/new/", source) == tmp_path / "new" / name
    assert output_in(tmp_path / "new", source) == tmp_path / "new"


def test_commands_write_into_folders(clip: Path) -> None:
    """A film, a track, a film of the track; never onto the input."""
    folder = clip.parent / "out"
    folder.mkdir()
    assert main(["animate", str(clip), "-o", str(folder), *QUICK]) == 0
    assert main(["solve", str(clip), "-o", f"{folder}/", *QUICK]) == 0
    track = folder / "clip.avi.mtrk"
    again = clip.parent / "again"
    again.mkdir()
    assert main(["render", str(track), "-o", str(again), "--progress", "none"]) == 0
    assert probe(folder / clip.name).frame_count == 6
    assert probe(again / "clip.avi.mp4").frame_count == 6
    assert main(["animate", str(clip), "-o", str(clip.parent), "--overwrite", *QUICK]) == 4
    assert main(["animate", str(clip), "-o", f"{clip.parent}/missing/", *QUICK]) == 0
    assert probe(clip.parent / "missing" / clip.name).frame_count == 6


def piped(arguments: list[str], given: bytes = b"") -> subprocess.CompletedProcess[bytes]:
    """Run a command in a pipe."""
    command = [sys.executable, "-m", "pipeline.cli", *arguments]
    return subprocess.run(command, input=given, capture_output=True, cwd=ROOT)


@pytest.mark.parametrize(
    ("name", "container"), [("-", "matroska"), ("-.mp4", "mov"), ("-.gif", "gif")]
)
def test_a_film_through_pipes(clip: Path, name: str, container: str) -> None:
    """An mp4 whose index may stand at its end comes in, any format goes out."""
    done = piped(["animate", "-", f"-o{name}", *QUICK], clip.read_bytes())
    assert done.returncode == 0, done.stderr
    target = clip.with_name("out")
    target.write_bytes(done.stdout)
    assert container in probe(target).container
    with open_decoder(target) as decoder:
        assert sum(1 for _ in decoder) == 6


def test_a_still_of_a_pipe_is_told_of(clip: Path) -> None:
    """`info` reads pipes, too."""
    done = piped(["info", "-"], clip.read_bytes())
    assert b"64x48 pixels" in done.stdout


def test_pipes_that_cannot_be(clip: Path) -> None:
    """Nothing comes in, rubbish comes in, standard output is needed twice."""
    assert piped(["info", "-"]).returncode == 3
    assert piped(["info", "-"], b"rubbish").returncode == 3
    twice = ["animate", str(clip), "-o", "-", "--progress", "json"]
    assert main(twice) == 2
    master, terminal = os.openpty()
    command = [sys.executable, "-m", "pipeline.cli", "info", "-"]
    assert subprocess.run(command, stdin=terminal, cwd=ROOT, timeout=60).returncode == 3
    os.close(master)
    os.close(terminal)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--start", "0:99"], "--start '0:99': seconds of a clock go up to 59; write 1:39"),
        (["--end", "1:75:00"], "--end '1:75:00': minutes of a clock go up to 59; write 2:15:00"),
        (["--start", "99"], "--start 99: no frame of"),
        (["--start", "1:39.5"], "--start 99.5: no frame of"),
        (["--start", "soon"], "--start 'soon': not a time"),
    ],
)
def test_times_are_told_by_name(
    clip: Path, arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Those that there are not, and those that are no clock."""
    out = os.fspath(clip.with_name("out.mp4"))
    assert main(["animate", str(clip), "-o", out, *arguments, *QUICK]) == 2
    assert told in capsys.readouterr().err
