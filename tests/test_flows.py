"""What every flow promises, and how well the search finds known motion."""

from collections.abc import Iterator

import cv2
import numpy as np
import pytest

from stages.flows import FLOWS
from stages.flows.dis import PRESETS, Dis
from stages.flows.field import FlowField
from stages.flows.view import View
from warp_kernels.errors import OptionError

SIZES = [(1, 1), (2, 2), (2, 720), (11, 40), (12, 12), (12, 320), (16, 320), (500, 13), (64, 48)]


@pytest.fixture(autouse=True)
def _restore_threads() -> Iterator[None]:
    before = cv2.getNumThreads()
    yield
    cv2.setNumThreads(before)


def textured(height: int, width: int, seed: int = 0) -> np.ndarray:
    """Smooth random texture, shape [H, W, 3] uint8."""
    noise = np.random.default_rng(seed).random((height, width)).astype(np.float32)
    smooth = cv2.GaussianBlur(noise, (0, 0), 3)
    grey = cv2.normalize(smooth, None, 0, 255, cv2.NORM_MINMAX).astype(np.uint8)
    return np.repeat(grey[..., None], 3, axis=2)


def shifted(height: int, width: int, dx: int, dy: int) -> tuple[np.ndarray, np.ndarray]:
    """A picture and the same one moved by whole pixels."""
    large = textured(height + 40, width + 40)
    return (
        np.ascontiguousarray(large[20 : 20 + height, 20 : 20 + width]),
        np.ascontiguousarray(large[20 - dy : 20 - dy + height, 20 - dx : 20 - dx + width]),
    )


@pytest.mark.parametrize(
    "size", [(1, 1), (2, 2), (2, 720), (11, 40), (12, 12), (13, 500), (64, 48)]
)
@pytest.mark.parametrize("name", FLOWS)
def test_every_flow_takes_every_size(name: str, size: tuple[int, int]) -> None:
    """Tiny, narrow and constant pictures give finite motion of the right shape."""
    for pixels in (textured(*size), np.full((*size, 3), 9, dtype=np.uint8)):
        field = FLOWS[name]().estimate(View(pixels), View(pixels[::-1].copy()))
        assert (field.height, field.width) == size
        motion = field.at(np.array([[0.0, 0.0], [size[1], size[0]], [0.5, 0.5]]))
        assert motion.shape == (3, 2)
        assert np.isfinite(motion).all()


@pytest.mark.parametrize("name", FLOWS)
def test_every_flow_leaves_a_still_picture_at_rest(name: str) -> None:
    """Two equal pictures have no motion."""
    pixels = textured(60, 80)
    field = FLOWS[name]().estimate(View(pixels), View(pixels.copy()))
    assert np.abs(field.vectors).max() < 0.02


@pytest.mark.parametrize("name", FLOWS)
def test_every_flow_is_equal_for_every_number_of_threads(name: str) -> None:
    """The vectors are the same bits for 1, 2 and 4 threads and for a second call."""
    before, after = shifted(120, 160, 3, -2)
    flow, results = FLOWS[name](), []
    for threads in (1, 2, 4, 4):
        cv2.setNumThreads(threads)
        results.append(flow.estimate(View(before), View(after)).vectors)
    assert all(np.array_equal(results[0], other) for other in results[1:])


@pytest.mark.parametrize("preset", PRESETS)
def test_dis_finds_a_shift(preset: str) -> None:
    """A shift by whole pixels is found, with its sign, away from the border."""
    before, after = shifted(120, 160, 6, -4)
    field = Dis(preset=preset).estimate(View(before), View(after))
    x, y = np.meshgrid(np.arange(30, 130, 5), np.arange(30, 90, 5))
    motion = field.at(np.stack([x.ravel(), y.ravel()], axis=1).astype(float))
    assert np.abs(motion - (6, -4)).mean() < 0.25


def test_reduced_pictures_give_motion_in_full_pixels() -> None:
    """Half the lines halve the pictures, not the vectors."""
    before, after = shifted(240, 320, 8, 4)
    field = Dis(lines=120).estimate(View(before), View(after))
    assert field.vectors.shape == (120, 160, 2)
    assert np.abs(field.at(np.array([[160.0, 120.0]])) - (8, 4)).max() < 0.5


def test_a_narrow_picture_is_still_when_reduced_below_the_limit() -> None:
    """Pictures under 12 px count as still instead of failing."""
    before, after = shifted(11, 300, 3, 0)
    assert not Dis().estimate(View(before), View(after)).vectors.any()


@pytest.mark.parametrize("size", [(12, 48), (14, 64), (16, 80), (20, 100), (28, 500), (31, 31)])
@pytest.mark.parametrize("preset", PRESETS)
def test_wide_and_low_pictures_do_not_crash(preset: str, size: tuple[int, int]) -> None:
    """Sizes at which OpenCV's own choice of pyramid levels reads out of bounds."""
    field = Dis(preset=preset).estimate(View(textured(*size)), View(textured(*size, seed=1)))
    assert np.isfinite(field.vectors).all()


def test_dis_refuses_what_it_cannot_do() -> None:
    """An unknown preset and too few lines are the user's errors."""
    with pytest.raises(OptionError, match="preset"):
        Dis(preset="slow")
    with pytest.raises(OptionError, match="lines"):
        Dis(lines=4)


def test_field_is_bilinear_between_cell_centres_and_constant_beyond() -> None:
    """A ramp is met exactly inside, and held outside the outermost centres."""
    ramp = np.zeros((3, 4, 2), dtype=np.float32)
    ramp[..., 0] = np.arange(4)
    ramp[..., 1] = 10 * np.arange(3)[:, None]
    field = FlowField(8, 6, ramp)  # cells of 2 px, centres at 1, 3, 5, 7
    points = np.array([[1, 1], [3, 1], [4, 1], [4, 2], [0, 0], [8, 6], [7, 5], [-5, 99]])
    expected = [[0, 0], [1, 0], [1.5, 0], [1.5, 5], [0, 0], [3, 20], [3, 20], [0, 20]]
    assert field.at(points.astype(float)).tolist() == expected


def test_field_refuses_other_shapes_and_types() -> None:
    """A field of float64 or of three components is a mistake of the caller."""
    with pytest.raises(ValueError, match="float32"):
        FlowField(4, 4, np.zeros((2, 2, 2)))
    with pytest.raises(ValueError, match="float32"):
        FlowField(4, 4, np.zeros((2, 2, 3), dtype=np.float32))
