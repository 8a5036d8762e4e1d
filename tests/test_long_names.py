"""Texts that no file can be named, wherever a file may stand: one short line, no search for it."""

import os
from pathlib import Path

import media_samples as samples
import pytest

from pipeline.cli import main
from pipeline.printable import LONGEST, one_line, printable
from tests.tracks import QUICK_FLAGS

LONG = "x" * 5000
"""Longer than any system takes."""
QUIET = ("--progress", "none")
READ = [
    "animate LONG -o out.mp4",
    "animate clip.mp4 -o out.mp4 --layout importance:LONG",
    "animate clip.mp4 -o out.mp4 --layout points:LONG",
    "animate clip.mp4 -o out.mp4 --weights LONG",
    "animate clip.mp4 -o out.mp4 --focus picture:LONG",
    "animate clip.mp4 -o out.mp4 --cuts LONG",
    "animate clip.mp4 -o out.mp4 --edits LONG",
    "animate clip.mp4 -o out.mp4 --style texture:LONG",
    "animate clip.mp4 -o out.mp4 --style LONG",
    "animate clip.mp4 -o out.mp4 --move assemble:LONG",
    "animate clip.mp4 -o out.mp4 --region LONG:flat",
    "animate clip.mp4 -o out.mp4 --region LONG@0:flat",
    "animate clip.mp4 -o out.mp4 --palette LONG",
    "animate clip.mp4 -o out.mp4 --timeline LONG",
    "animate clip.mp4 -o out.mp4 --timeline pulse --beats LONG",
    "animate clip.mp4 -o out.mp4 --audio LONG",
    "animate clip.mp4 -o out.mp4 --preset LONG",
    "animate clip.mp4 -o out.svg --relief 0.1:LONG",
    "render LONG -o out.mp4",
    "join LONG -o out.mtrk",
    "info LONG",
    "measure clip.mp4 LONG",
    "styles LONG",
    "listen clip.mp4 --beats LONG",
    "timeline LONG --check clip.mp4",
]
WRITTEN = [
    "animate clip.mp4 -o LONG.mp4",
    "animate clip.mp4 -o LONG/",
    "animate clip.mp4 -o LONG/out.mp4",
    "animate clip.mp4 -o LONG_##.png",
    "animate clip.mp4 -o out.mp4 --track LONG.mtrk",
    "solve clip.mp4 -o LONG.mtrk",
    "preview clip.mp4 -o LONG.png",
    "listen clip.mp4 -o LONG.json",
    "listen clip.mp4 --plot LONG.png",
    "listen clip.mp4 --labels LONG.txt",
    "styles --sheet LONG.png",
    "timeline pulse --check clip.mp4 -o LONG.png",
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a clip that has a sound."""
    folder = tmp_path_factory.mktemp("long")
    pictures = [samples.picture(32, 24, n) for n in range(2)]
    samples.write_video(folder / "clip.mp4", pictures, sound=1)
    return folder


def told(command: str, long: str, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Exit code and what is said."""
    words = [word.replace("LONG", long) for word in command.split()]
    animates = words[0] in ("animate", "solve")
    code = main([*words, *(QUICK_FLAGS if animates else ()), *(QUIET if animates else ())])
    return code, capsys.readouterr().err


@pytest.mark.parametrize("command", [*READ, *WRITTEN])
@pytest.mark.parametrize("long", [LONG, "y" * 300], ids=["endless", "too-long"])
def test_it_is_one_short_line(
    command: str, long: str, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    """With the code of a mistake, and nothing is left behind."""
    monkeypatch.chdir(folder)
    code, line = told(command, long, capsys)
    assert code in (2, 3, 4), line
    assert line.count("\n") == 1, line
    assert len(line) < 1200, line
    assert "internal error" not in line, line
    assert os.listdir(folder) == ["clip.mp4"]


def test_nothing_of_a_name_commands_the_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    """A file of such a name is told with its letters spelled, in errors and in what is found."""
    monkeypatch.chdir(tmp_path)
    name = "a\x1b]0;owned\x07\x9b31m.png"
    samples.write_still(tmp_path / "a.png", samples.picture(16, 8)).rename(tmp_path / name)
    bad = "b\x1b[2J.mp4"
    (tmp_path / bad).write_bytes(b"nothing")
    assert main(["info", name]) == 0
    assert main(["info", bad]) == 3
    assert main(["animate", bad, name, "-o", "out/", *QUICK_FLAGS, "--progress", "plain"]) == 3
    assert main(["help", "\x1b[31m"]) == 2
    captured = capsys.readouterr()
    for text in (captured.out, captured.err):
        assert "\x1b" not in text
        assert "\x9b" not in text
    assert r"b\x1b[2J.mp4" in captured.err


def test_what_is_shown_of_a_text() -> None:
    """Letters of all languages are shown; a word as long as a name may be is shown whole."""
    assert printable("Größe 影\nzwei") == "Größe 影\nzwei"
    assert printable("a\tb\udcff\u202e") == r"a\tb\udcff\u202e"
    assert one_line(f" a \n{'b' * LONGEST} ") == f"a {'b' * LONGEST}"
    assert len(one_line("b" * 5000)) < LONGEST
