"""`trimotion info`: lines for people, JSON for programs."""

import json
from dataclasses import fields
from pathlib import Path

import cv2
import jsonschema
import numpy as np
import pytest

from pipeline.cli import main
from stages.media import MediaInfo
from tests import media_samples as samples
from tests.tracks import solve_to, write_clip

CLIP = Path(__file__).parents[1] / "sample_videos" / "shapes.mp4"


def test_lines_tell_what_a_clip_is(capsys) -> None:
    """Aligned labels and values."""
    assert main(["info", str(CLIP)]) == 0
    lines = capsys.readouterr().out.splitlines()
    rows = dict(line.split("  ", 1) for line in lines)
    values = {label: value.strip() for label, value in rows.items()}
    assert values["size"].startswith("640x360 pixels")
    assert values["rate"] == "25 frames a second"
    assert values["audio"].startswith("aac")
    starts = {len(line) - len(line.split("  ", 1)[1].lstrip()) for line in lines}
    assert len(starts) == 1


def test_json_tells_the_same_exactly(capsys) -> None:
    """Times are exact fractions."""
    assert main(["info", str(CLIP), "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    assert (values["width"], values["height"], values["kind"]) == (640, 360, "video")
    assert values["average_rate"] == "25"
    assert values["time_base"].startswith("1/")


@pytest.mark.parametrize("form", ["lines", "json"])
def test_picture_and_stills(form: str, tmp_path: Path, capsys) -> None:
    """A still has no rate; numbered stills are counted."""
    for number in (1, 2, 3):
        cv2.imwrite(str(tmp_path / f"s_{number:02d}.png"), np.zeros((6, 8, 3), np.uint8))
    more = ["--json"] if form == "json" else []
    assert main(["info", str(tmp_path / "s_01.png"), *more]) == 0
    still = capsys.readouterr().out
    assert main(["info", str(tmp_path / "s_##.png"), *more]) == 0
    stills = capsys.readouterr().out
    if form == "json":
        assert json.loads(still)["frame_count"] == 1
        assert json.loads(stills)["frame_count"] == 3
    else:
        assert "8x6 pixels" in still
        assert "rate" not in still
        assert "frames     3" in stills


def test_unreadable_file_is_one_line(tmp_path: Path, capsys) -> None:
    """Exit code 3, nothing on standard output."""
    path = tmp_path / "text.mp4"
    path.write_text("no media")
    for name in (path, tmp_path / "missing.mp4", tmp_path):
        assert main(["info", str(name)]) == 3
        captured = capsys.readouterr()
        assert captured.out == ""
        assert captured.err.startswith(f"trimotion: error: {name}: ")
        assert captured.err.count("\n") == 1


def test_json_keeps_to_its_schema(tmp_path: Path, capsys) -> None:
    """Films, stills, numbered stills and tracks; another key or kind of value is refused."""
    schema = json.loads((CLIP.parents[1] / "docs" / "info.schema.json").read_text("utf-8"))
    validator = jsonschema.Draft202012Validator(schema)
    validator.check_schema(schema)
    for number in (1, 2):
        samples.write_still(tmp_path / f"s_{number:02d}.png", samples.picture(32, 24))
    clip = write_clip(tmp_path / "clip.mp4")
    solve_to(tmp_path / "t.mtrk", clip, "0-2")
    for name in (clip, CLIP, tmp_path / "s_01.png", tmp_path / "s_##.png", tmp_path / "t.mtrk"):
        assert main(["info", str(name), "--json"]) == 0
        printed = json.loads(capsys.readouterr().out)
        validator.validate(printed)
        for change in ({"unknown": 1}, {"kind": "other"}):
            assert not validator.is_valid({**printed, **change})
    described = {key for part in schema["$defs"].values() for key in part["properties"]}
    assert {field.name for field in fields(MediaInfo)} <= described
