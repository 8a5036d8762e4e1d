"""`trimotion doctor`: what a machine has, and yes or no."""

import json
from pathlib import Path

import pytest

from pipeline.cli import main
from pipeline.commands import doctor


def test_a_machine_on_which_it_works(capsys) -> None:
    """All facts, no trouble with the film, and yes as the last word."""
    assert main(["doctor"]) == 0
    lines = capsys.readouterr().out.splitlines()
    named = {line.split("  ")[0] for line in lines}
    assert named >= {"program", "libraries", "device", "encoders", "kernels", "free space", "test"}
    assert lines[-1].split() == ["works", "yes"]


def test_for_programs(capsys, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same as JSON; control characters of a folder's name stay in it, and only there."""
    monkeypatch.setattr(doctor, "_trial", tuple)
    monkeypatch.setattr(doctor, "_kernels", lambda: "in a\x1b[31mfolder")
    assert main(["doctor", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["works"], found["kernels"]) == (True, "in a\x1b[31mfolder")
    assert main(["doctor"]) == 0
    assert "\x1b" not in capsys.readouterr().out


def test_a_machine_on_which_it_does_not(
    tmp_path: Path, capsys, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What hinders is told in a line, then no; exit code 1."""
    for name in ("TMPDIR", "TEMP", "TMP"):
        monkeypatch.setenv(name, str(tmp_path))
    monkeypatch.setattr(doctor.tempfile, "tempdir", str(tmp_path / "gone"))
    monkeypatch.setattr(doctor, "_places", lambda: iter([(tmp_path, 5)]))
    monkeypatch.setattr(doctor, "_has", lambda codec: codec != "av1")
    assert main(["doctor"]) == 1
    text = capsys.readouterr().out
    assert "no film can be made: " in text
    assert f"little space is free in {tmp_path}" in text
    assert "FFmpeg has no encoder for av1" in text
    assert text.splitlines()[-1].split() == ["works", "no"]


@pytest.mark.parametrize("names", [("a\0b", "-o", "c.mtrk"), ("a", "-o", "c\0.mtrk")])
def test_null_bytes_are_no_internal_error(names: tuple[str, ...], capsys) -> None:
    """`join` compared names before anything was known of them."""
    assert main(["join", *names]) in (3, 4)
    line = capsys.readouterr().err
    assert line.count("\n") == 1
    assert "internal" not in line
