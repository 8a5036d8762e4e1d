"""A preview shows moments of the film that will be, and tells a time."""

import json
from pathlib import Path

import cv2
import media_samples as samples
import numpy as np
import pytest

from pipeline.cli import main
from pipeline.commands.preview_sheet import WIDTH
from pipeline.loop.preview import JUMP, RUN_IN, Preview, later_seconds
from stages.look.sheet import CAPTION, GAP
from tests.kernel_samples import waves

QUICK = ["--triangles", "20", "--iterations", "4", "--frame-iterations", "2", "--progress", "none"]


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """Twenty frames of waves that move."""
    frames = [np.roll(waves(64, 48), 2 * k, axis=1) for k in range(20)]
    return samples.write_video(tmp_path / "in.mp4", frames)


def test_five_moments_and_a_time(clip: Path, tmp_path: Path, monkeypatch, capsys) -> None:
    """Evenly spread over the range, in one picture beside which nothing is left."""
    monkeypatch.chdir(tmp_path)
    assert main(["preview", str(clip), *QUICK, "--json", "--frames", "0-19x2"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert figures["moments"] == [2, 6, 10, 14, 18]
    assert figures["frames"] == 10
    assert figures["output"] == "in.preview.png"
    assert main(["preview", str(clip), "-o", str(tmp_path), *QUICK, "--overwrite"]) == 0
    sheet = cv2.imread("in.preview.png")
    assert sheet.shape == (GAP + WIDTH * 3 // 4 + CAPTION + GAP, GAP + 5 * (WIDTH + GAP), 3)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.mp4", "in.preview.png"]
    assert main(["preview", str(clip), *QUICK]) == 4
    assert "exists already" in capsys.readouterr().err


def test_preview_has_the_look_and_the_shape(clip: Path, tmp_path: Path, capsys) -> None:
    """Of the film that it is of: fitted, with bars."""
    out = tmp_path / "p.png"
    look = ["--size", "48x48", "--background", "red", "--frames", "3-4"]
    assert main(["preview", str(clip), "-o", str(out), *QUICK, *look]) == 0
    assert capsys.readouterr().out.startswith("2 frames")
    sheet = cv2.imread(str(out))
    assert sheet.shape[1] == GAP + 2 * (WIDTH + GAP)
    blue, green, red = sheet[GAP + 3, GAP + WIDTH // 2].tolist()
    assert red > 200 > 60 > max(blue, green)


def test_still_has_one_moment(tmp_path: Path, capsys) -> None:
    """And no later frame."""
    still = samples.write_still(tmp_path / "a.png", samples.picture(32, 24))
    assert main(["preview", str(still), "-o", str(tmp_path / "p.png"), *QUICK, "--json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert (figures["moments"], figures["seconds_later"]) == ([0], 0)


def test_what_no_preview_can_be(clip: Path, tmp_path: Path, capsys) -> None:
    """A film as the sheet, a region that is followed, a range without a frame."""
    mask = samples.write_still(tmp_path / "m.png", samples.picture(64, 48))
    for more, word in (
        (["-o", str(tmp_path / "p.mp4")], "one picture"),
        (["--region", f"{mask}@3:hatching"], "followed"),
        (["--frames", "50-60"], "there are none"),
    ):
        assert main(["preview", str(clip), "-o", str(tmp_path / "p.png"), *QUICK, *more]) == 2
        assert word in capsys.readouterr().err


@pytest.mark.parametrize("draws", [0.0, 0.1, 0.6])
def test_times_are_those_of_later_frames(draws: float) -> None:
    """Not of first ones, nor of what was prepared while these were solved, nor of other shots'.

    Solving a frame takes a quarter of a second; drawing takes less or more, and two seconds once.
    """
    each = 0.25
    runs = []
    for count in (1, 8, 1, 8, 1):
        times = [5.0, 8.0]
        for number in range(count):
            steps = 0.01 if number < RUN_IN else max(each, draws)
            times.append(times[-1] + steps)
        runs.append((np.array(times), times[1] + 2.0 + (count + 1) * max(each, draws)))
    assert later_seconds(runs) == pytest.approx(max(each, draws))
    runs[1][0][-1] += 2 * JUMP * each  # a cut
    assert later_seconds(runs) == pytest.approx(max(each, draws))


def test_time_of_the_whole() -> None:
    """A first frame, and the others; of a still the first one alone."""
    assert Preview((), 101, 3.0, 0.25, ()).seconds == pytest.approx(28.0)
    assert later_seconds([(np.array([0.0, 2.0]), 2.5)]) == 0.0
