"""Progress knows how many frames there will be."""

import json
from dataclasses import replace
from pathlib import Path

import media_samples as samples
import pytest

from pipeline.cli import main
from stages.media import FrameRange, probe
from stages.media.expected_frames import expected_frames


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("0-", 20),
        ("0-5", 0),
        ("1002-1003", 2),
        ("1002-", 19),
        ("1001-1020", 20),
        ("0-2000", 20),
        ("1000-1004x2", 2),
        ("1001-1004x2", 2),
        ("1001-1005x2", 3),
        ("1019-1500", 2),
    ],
)
def test_numbers_of_stills_count(tmp_path: Path, text: str, count: int) -> None:
    """Stills 1001 to 1020: as many as have a number in the range."""
    info = probe(samples.write_still(tmp_path / "a.png", samples.picture(16, 8)))
    info = replace(info, frame_count=20, first_frame=1001)
    wanted = FrameRange.parse(text)
    assert expected_frames(wanted, info) == count
    assert count == sum(wanted.holds(n, 0) for n in range(1001, 1021))


def test_progress_of_numbered_stills(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The total is right from the first line on."""
    for number in range(1001, 1005):
        samples.write_still(tmp_path / f"s.{number}.png", samples.picture(64, 48, number))
    name, out = str(tmp_path / "s.####.png"), str(tmp_path / "out.mp4")
    quick = ["--triangles", "20", "--iterations", "2", "--progress", "json"]
    assert main(["animate", name, "-o", out, "--frames", "1002-1003", *quick]) == 0
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    frames = [event for event in events if event["event"] == "frame"]
    assert [(event["done"], event["total"]) for event in frames] == [(1, 2), (2, 2)]
