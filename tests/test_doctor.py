"""`trimotion doctor`: what a machine has, and yes or no."""

import json
import tempfile
from pathlib import Path

import pytest

from pipeline.cli import main
from pipeline.commands.doctor import Examination


def test_a_machine_on_which_it_works(capsys) -> None:
    """All facts, no trouble with the film, and yes as the last word."""
    assert main(["doctor"]) == 0
    lines = capsys.readouterr().out.splitlines()
    named = {line.split("  ")[0] for line in lines}
    assert named >= {"program", "libraries", "device", "encoders", "kernels", "free space", "test"}
    assert lines[-1].split() == ["works", "yes"]


def test_a_machine_on_which_it_does_not(
    tmp_path: Path, capsys, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What hinders is told in a line, then no; exit code 1."""
    place = tmp_path / "file"
    place.write_text("no folder")
    # real need: Python falls back to other folders if the environment names a bad one
    monkeypatch.setattr(tempfile, "tempdir", str(place))
    assert main(["doctor", "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert not found["works"]
    assert any("no film can be made: " in trouble for trouble in found["troubles"])


def test_what_is_found_is_printed_plainly() -> None:
    """Names of folders command no terminal; troubles stand before the last word."""
    found = Examination({"kernels": "in a\x1b[31mfolder"}, ("little\x07space",), works=False)
    assert found.as_lines().splitlines() == [
        "kernels  in a\\x1b[31mfolder",
        "note     little\\x07space",
        "works    no",
    ]
    assert found.as_dict()["kernels"] == "in a\x1b[31mfolder"


@pytest.mark.parametrize("names", [("a\0b", "-o", "c.mtrk"), ("a", "-o", "c\0.mtrk")])
def test_null_bytes_are_no_internal_error(names: tuple[str, ...], capsys) -> None:
    """`join` compared names before anything was known of them."""
    assert main(["join", *names]) in (3, 4)
    line = capsys.readouterr().err
    assert line.count("\n") == 1
    assert "internal" not in line
