"""E_warp and tOF: pictures whose motion is known have known errors; cuts are not compared."""

import gc
import json
import weakref
from fractions import Fraction
from pathlib import Path

import cv2
import numpy as np
import pytest
from test_measure import WHOLE, gray, write_clip, write_still

from pipeline.cli import main
from pipeline.compare.coherence import CoherenceMeter
from pipeline.compare.measure import measure
from pipeline.compare.pairs import Matched
from stages.flows.field import FlowField
from stages.metrics.motion import SourceMotion
from stages.metrics.motion_difference import motion_difference
from stages.metrics.visible import visible
from stages.metrics.warp_error import warp_error
from tests.kernel_samples import frame_of

FRAME_KEYS = {
    *("frame", "time", "rmse", "psnr", "R", "track"),
    *("E_warp_1", "E_warp_4", "source_E_warp_1", "source_E_warp_4", "tOF"),
}
REPORT_KEYS = {
    *("source", "output", "width", "height", "frames", "rmse", "psnr", "R", "track"),
    *("E_warp_1", "E_warp_4", "source_E_warp_1", "source_E_warp_4", "tOF"),
    *("worst", "notes", "per_frame"),
}


def moving(width: int, height: int, dx: float, dy: float) -> SourceMotion:
    """The same motion everywhere."""
    flows = [np.full((1, 1, 2), (sign * dx, sign * dy), np.float32) for sign in (1, -1)]
    return SourceMotion(*(FlowField(width, height, vectors) for vectors in flows))


def texture(width: int, height: int) -> np.ndarray:
    """Smooth blobs of all colours, [H, W, 3] uint8."""
    noise = np.random.default_rng(3).random((height, width, 3))
    smooth = cv2.GaussianBlur(noise, (0, 0), 4.0)
    return np.rint(255 * (smooth - smooth.min()) / np.ptp(smooth)).astype(np.uint8)


def pan(count: int, step: int, size: tuple[int, int] = (96, 64)) -> list[np.ndarray]:
    """A picture that moves left by whole pixels."""
    wide = texture(size[0] + step * count, size[1])
    return [np.ascontiguousarray(wide[:, step * n : step * n + size[0]]) for n in range(count)]


def test_picture_that_moves_with_its_source_has_no_error(rng: np.random.Generator) -> None:
    """Whole pixels: 0 over what both show, whatever enters at the border."""
    wide = rng.integers(0, 256, (60, 80, 3), dtype=np.uint8)
    earlier, later = wide[5:45, 10:60], wide[3:43, 13:63]
    motion = moving(50, 40, -3, 2)
    assert warp_error(earlier, later, motion) < 1e-12
    expected = np.zeros((40, 50), bool)
    expected[:-2, 3:] = True
    np.testing.assert_array_equal(motion.visible, expected)
    assert warp_error(earlier, later, moving(50, 40, 0, 0)) > 0.05


def test_part_of_a_pixel_is_interpolated() -> None:
    """A ramp that moves by 1.25 px is met, but for half a pixel beyond the last centre."""
    ramp = np.repeat(np.arange(0, 240, 4.0)[None, :, None], 20, 0).repeat(3, 2)
    assert warp_error(ramp, ramp - 5.0, moving(60, 20, 1.25, 0)) < 1e-6
    assert warp_error(ramp, ramp, moving(60, 20, 1.25, 0)) == pytest.approx(
        (5 / 255) ** 2, rel=0.01
    )


def test_what_is_covered_is_not_compared() -> None:
    """A square moves right by 4 px over a still ground: the strip before it gets hidden."""
    forward, backward = np.zeros((2, 40, 60, 2), np.float32)
    forward[10:30, 20:40, 0] = 4.0
    backward[10:30, 24:44, 0] = -4.0
    seen = visible(forward, backward)
    assert not seen[10:30, 40:44].any()
    assert seen[11:29, 21:39].all()
    assert seen[:, :19].all()
    assert seen[:, 45:].all()
    assert not seen[10:30, 19].any()  # a motion boundary


def test_nothing_seen_is_no_value() -> None:
    """Motion that leads out of the picture leaves nothing to compare."""
    assert warp_error(gray(5), gray(9), moving(16, 12, 99, 0)) is None


def test_difference_of_motion_is_in_pixels() -> None:
    """A source that moves by 2 px, an output that stands still or moves alike."""
    source = pan(2, 2)
    assert motion_difference((source[0], source[1]), (source[0], source[1])) == 0.0
    still = motion_difference((source[0], source[1]), (source[0], source[0]))
    assert still == pytest.approx(2.0, rel=0.15)


@pytest.mark.parametrize("side", [1, 2, 7, 11, 12])
def test_smallest_pictures_have_values(side: int) -> None:
    """Below what flows accept, sources count as still."""
    one, other = gray(100, side, side), gray(151, side, side)
    motion = SourceMotion.between(one, one)
    assert warp_error(one, other, motion) == pytest.approx(0.04)
    assert motion_difference((one, one), (one, other)) == 0.0


def test_flicker_has_a_known_error(tmp_path: Path) -> None:
    """A still source, an output that changes by 51 of 255 every frame, and one that does not."""
    source = write_clip(tmp_path / "a.mkv", [texture(48, 32)] * 6)
    output = write_clip(tmp_path / "b.mkv", [gray(100 + 51 * (n % 2), 48, 32) for n in range(6)])
    report = measure(source, output, WHOLE)
    assert report.coherence.warp_errors[1] == pytest.approx(0.04)
    assert report.coherence.warp_errors[4] == 0.0  # the same grey again
    assert report.coherence.source_warp_errors == {1: 0.0, 4: 0.0}
    assert report.coherence.motion_difference < 0.01
    missing = [[f.coherence.warp_errors[lag] is None for f in report.frames] for lag in (1, 4)]
    assert missing == [[True] + 5 * [False], 4 * [True] + 2 * [False]]


def test_slow_drift_shows_at_the_longer_lag(tmp_path: Path) -> None:
    """5.1 of 255 each frame: (1/50)^2 at once, (4/50)^2 four frames apart."""
    pictures = [gray(100, 24, 24) for _ in range(6)]
    for number, picture in enumerate(pictures):
        picture[...] += 5 * number
    source = write_clip(tmp_path / "a.mkv", [texture(24, 24)] * 6)
    report = measure(source, write_clip(tmp_path / "b.mkv", pictures), WHOLE)
    for lag, error in report.coherence.warp_errors.items():
        assert error == pytest.approx((5 * lag / 255) ** 2)


def test_pan_drawn_coherently_has_almost_no_error(tmp_path: Path) -> None:
    """The output moves with its source; one that stands still does not."""
    pictures = pan(6, 2)
    source = write_clip(tmp_path / "a.mkv", pictures)
    inverse = write_clip(tmp_path / "b.mkv", [255 - picture for picture in pictures])
    report = measure(source, inverse, WHOLE)
    assert report.coherence.warp_errors[1] < 1e-4
    assert report.coherence.warp_errors[4] < 1e-3
    assert report.coherence.motion_difference < 0.1
    frozen = measure(source, write_clip(tmp_path / "c.mkv", pictures[:1] * 6), WHOLE)
    for lag in (1, 4):
        own = report.coherence.source_warp_errors[lag]
        assert own == frozen.coherence.source_warp_errors[lag]  # it is the source's own
        assert frozen.coherence.warp_errors[lag] > 20 * own
    assert frozen.coherence.motion_difference > 1.5


def test_shots_are_not_compared(tmp_path: Path) -> None:
    """A cut in the middle: no value there, none four frames after it, and no error elsewhere."""
    shots = [texture(48, 32)] * 5 + [255 - texture(48, 32)[::-1]] * 5
    clip = write_clip(tmp_path / "a.mkv", shots)
    report = measure(clip, clip, WHOLE)
    known = [f.coherence.warp_errors[1] is not None for f in report.frames]
    assert known == [False] + 4 * [True] + [False] + 4 * [True]
    known = [f.coherence.warp_errors[4] is not None for f in report.frames]
    assert known == 4 * [False] + [True] + 4 * [False] + [True]
    assert report.coherence.warp_errors == {1: 0.0, 4: 0.0}


def test_json_keeps_its_keys(tmp_path: Path, capsys) -> None:
    """Programs rely on them; what there is not is null."""
    clip = str(write_clip(tmp_path / "a.mkv", [gray(50), gray(50)]))
    assert main(["measure", clip, clip, "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    assert values.keys() == REPORT_KEYS
    assert values["worst"].keys() == FRAME_KEYS
    assert [frame.keys() for frame in values["per_frame"]] == [FRAME_KEYS] * 2
    assert (values["E_warp_1"], values["E_warp_4"], values["track"]) == (0.0, None, None)


def test_table_tells_coherence_of_clips_only(tmp_path: Path, capsys) -> None:
    """Thousandths, beside those of the source; a still has no time."""
    source = str(write_clip(tmp_path / "a.mkv", [gray(100, 24, 24)] * 2))
    pictures = [gray(100, 24, 24), gray(151, 24, 24)]
    output = str(write_clip(tmp_path / "b.mkv", pictures))
    assert main(["measure", source, output]) == 0
    lines = capsys.readouterr().out.splitlines()
    found = {line.split("  ")[0]: line.split()[-2:] for line in lines}
    assert found["E_warp, lag 1 [1e-3]"] == ["40.000", "0.000"]
    assert found["E_warp, lag 4 [1e-3]"] == ["-", "-"]
    assert found["tOF [px]"][-1] == "0.000"
    still = str(write_still(tmp_path / "a.png", gray(100)))
    assert main(["measure", still, still]) == 0
    assert "E_warp" not in capsys.readouterr().out


def test_few_frames_are_kept() -> None:
    """Memory does not grow with the clip."""
    gc.freeze()  # of all that other tests have left nothing is looked at each time
    meter, shown, alive = CoherenceMeter(), [], []
    for number in range(9):
        picture = gray(50)
        shown.append(weakref.ref(picture))
        meter.add(Matched(frame_of(gray(60), number), picture, Fraction(number, 25)), 0)
        del picture
        gc.collect()
        alive.append(sum(one() is not None for one in shown))
    assert alive == [1, 2, 3, 4, 4, 4, 4, 4, 4]
