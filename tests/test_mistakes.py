"""Mistakes in options are told word for word as `golden/mistakes.txt` has it.

Each has two lines there: what follows `trimotion animate in.mp4 -o out.mp4`, and what is told.
After a change that is meant, `pytest tests/test_mistakes.py --update-golden` stores the new words;
read them before you commit them.
"""

from pathlib import Path

import pytest

from pipeline.cli import main

STORED = Path(__file__).parent / "golden" / "mistakes.txt"


def told(flags: str, capsys: pytest.CaptureFixture) -> str:
    """The one line with which the command ends."""
    assert main(["animate", "in.mp4", "-o", "out.mp4", *flags.split()]) == 2
    captured = capsys.readouterr()
    assert (captured.out, captured.err.count("\n")) == ("", 1)
    return captured.err.strip()


def test_words_are_those_that_are_stored(capsys, tmp_path, monkeypatch, request) -> None:
    """One mistake of every kind: in values, names, parameters, presets, in what goes together."""
    lines = STORED.read_text(encoding="utf-8").splitlines()
    monkeypatch.chdir(tmp_path)
    found = []
    for flags in lines[::2]:
        if flags.startswith("preset "):  # what it holds, lines parted by |
            Path("my.toml").write_text(flags.removeprefix("preset ").replace("|", "\n"))
            found += [flags, told("--preset my.toml", capsys)]
        else:
            found += [flags, told(flags, capsys)]
    if request.config.getoption("--update-golden"):
        STORED.write_text("\n".join(found) + "\n", encoding="utf-8")
        lines = found
    assert found == lines
