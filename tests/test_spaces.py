"""What every space of the error promises, its definition, and that drawn colours stay RGB."""

from collections.abc import Iterator
from dataclasses import replace

import cv2
import numpy as np
import pytest

import trimotion
from stages.layouts import LAYOUTS
from stages.optimize_options import OptimizeOptions
from stages.snapshot import Snapshot
from stages.spaces import SPACES
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from stages.validate import assert_valid
from tests.kernel_samples import frame_of, noise, waves
from tests.oracles.coverage import covered_pixels, rounded
from tests.oracles.oklab import oklab_of
from warp_kernels.device.device import Device

SIZES = [(1, 1), (1, 7), (5, 1), (13, 17), (64, 33)]
GREYS = np.repeat(np.arange(256, dtype=np.uint8)[None, :, None], 3, axis=2)
OPTIONS = TriangulateOptions(iterations=60, refine=RefineOptions(triangles=80))


@pytest.fixture(autouse=True)
def _restore_threads() -> Iterator[None]:
    before = cv2.getNumThreads()
    yield
    cv2.setNumThreads(before)


def triangulated(picture: np.ndarray, space: str, device: str = "cpu", **others) -> Snapshot:
    """A picture's snapshot with the error in a space."""
    options = TriangulateOptions(
        iterations=OPTIONS.iterations, refine=OPTIONS.refine, space=space, **others
    )
    size = (picture.shape[1], picture.shape[0])
    triangulator = Triangulator(Device(device, 1), size, options)
    return triangulator.first(frame_of(picture), LAYOUTS["grid"](), np.random.default_rng(0))


def rmse_of_colors(snapshot: Snapshot, picture: np.ndarray) -> float:
    """Error of a snapshot's constant colours in RGB, pixel by pixel [code values]."""
    height, width = picture.shape[:2]
    total = 0.0
    for corners, color in zip(snapshot.mesh.corners, snapshot.coefficients[:, :, 0], strict=True):
        _, pixels = covered_pixels([rounded(*corner) for corner in corners], width, height)
        columns, rows = np.array(pixels, dtype=int).reshape(-1, 2).T
        total += ((picture[rows, columns] - color) ** 2).sum()
    return float(np.sqrt(total / picture.size))


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", SPACES)
def test_every_space_looks_at_single_pixels(name: str, size: tuple[int, int]) -> None:
    """Shape and type stay; a pixel's values depend on neither place, threads nor repetition."""
    pixels = noise(size[1], size[0])
    space = SPACES[name]()
    results = []
    for threads in (1, 2, 2):
        cv2.setNumThreads(threads)
        results.append(space.convert(pixels))
    assert results[0].shape == pixels.shape
    assert results[0].dtype == np.uint8
    assert results[0].flags.c_contiguous
    assert all(np.array_equal(results[0], other) for other in results[1:])
    alone = [space.convert(pixel.reshape(1, 1, 3)) for pixel in pixels.reshape(-1, 3)[-40:]]
    assert np.array_equal(np.concatenate(alone).reshape(-1, 3), results[0].reshape(-1, 3)[-40:])


@pytest.mark.parametrize("name", SPACES)
def test_every_space_orders_greys(name: str) -> None:
    """Greys keep black, white and their order, and have no colour."""
    converted = SPACES[name]().convert(GREYS)[0].astype(int)
    assert converted[0, 0] == 0
    assert converted[255, 0] == 255
    assert (np.diff(converted[:, 0]) >= 0).all()

    if name == "oklab":
        assert (converted[:, 1:] == 128).all()
    else:
        assert (converted == GREYS[0]).all()


def test_oklab_is_that_of_its_author() -> None:
    """The published colours and random ones agree with the definition, to the nearest integer."""
    pixels = noise(200, 150)
    pixels[0, :3] = np.eye(3) * 255
    expected = oklab_of(pixels) * 255 + (0, 128, 128)
    converted = SPACES["oklab"]().convert(pixels)
    assert np.abs(converted - expected).max() < 0.7
    published = [[0.62796, 0.22486, 0.12585], [0.86644, -0.23389, 0.17950]]
    np.testing.assert_allclose(oklab_of(pixels[:1, :2])[0], published, atol=2e-4)


def test_oklab_fits_into_its_integers() -> None:
    """The corners and edges of the cube, where L, a and b are extreme, are not clipped."""
    ramp = np.linspace(0, 255, 52).astype(np.uint8)
    pixels = np.stack(np.meshgrid(ramp, ramp, ramp), axis=-1).reshape(52, -1, 3)
    converted = SPACES["oklab"]().convert(pixels)
    assert converted[..., 1].min() == 68
    assert converted[..., 1].max() == 198
    assert converted[..., 2].min() >= 49
    assert converted[..., 2].max() <= 179


def test_luma_is_that_of_bt709() -> None:
    """The weighted sum of the code values, three times."""
    pixels = noise(60, 40)
    converted = SPACES["luma"]().convert(pixels)
    assert np.abs(converted[..., 0] - pixels @ np.array([0.2126, 0.7152, 0.0722])).max() < 0.6
    assert (converted == converted[..., :1]).all()


@pytest.mark.parametrize("color", ["constant", "linear"])
@pytest.mark.parametrize("name", SPACES)
def test_every_space_draws_rgb(name: str, color: str, device: str) -> None:
    """Colours and rmse of the snapshot are those of the picture itself."""
    picture = waves(97, 71)
    snapshot = triangulated(picture, name, device, color=color)
    assert_valid(snapshot.mesh)
    assert snapshot.model.name == color
    if color == "constant":
        assert snapshot.rmse == pytest.approx(rmse_of_colors(snapshot, picture), rel=1e-6)
    mean = picture.reshape(-1, 3).mean(axis=0)
    assert snapshot.rmse < 0.6 * np.sqrt(((picture - mean) ** 2).mean())


def test_grey_picture_is_the_same_in_rgb_and_luma(device: str) -> None:
    """Luma keeps the scale: a grey picture gives the same triangles, whatever --error asks."""
    grey = np.repeat(waves(80, 60)[..., :1], 3, axis=2)
    refine = RefineOptions(triangles=400, error=0.8)
    options = (TriangulateOptions(iterations=40, refine=refine, space=s) for s in ("rgb", "luma"))
    first, second = (
        Triangulator(Device(device, 1), (80, 60), each).first(
            frame_of(grey), LAYOUTS["grid"](), np.random.default_rng(0)
        )
        for each in options
    )
    np.testing.assert_array_equal(first.mesh.vertices, second.mesh.vertices)
    np.testing.assert_array_equal(first.coefficients, second.coefficients)


def test_luma_does_not_see_colours_of_equal_brightness() -> None:
    """An edge between equally bright colours is found in RGB and Oklab, and not in luma."""
    picture = np.full((60, 90, 3), (200, 60, 90), dtype=np.uint8)
    y, x = np.mgrid[:60, :90]
    picture[x + y // 2 > 60] = (60, 100, 101)
    assert len(np.unique(SPACES["luma"]().convert(picture))) == 1
    errors = {name: triangulated(picture, name).rmse for name in SPACES}
    assert max(errors["rgb"], errors["oklab"]) < 0.3 * errors["luma"]


def test_a_film_in_oklab_weighs_as_the_stage_does() -> None:
    """Weights come with a frame, and options with its number: what a space asks for stays."""
    picture = waves(97, 71)
    weights = np.full(picture.shape[:2], 80, np.uint8)
    weights[20:50, 30:60] = 255
    seen = trimotion.triangulate(
        picture, space="oklab", weights=weights, triangles=80, iterations=40, threads=1
    )
    options = TriangulateOptions(
        space="oklab", iterations=40, refine=replace(OPTIONS.refine, triangles=80)
    )
    frame = replace(frame_of(picture), weights=weights)
    triangulator = Triangulator(Device("cpu", 1), (97, 71), options)
    direct = triangulator.first(frame, LAYOUTS["importance"](), np.random.default_rng([0, 0]))
    np.testing.assert_array_equal(seen.vertices, direct.mesh.vertices)


def test_regularity_weighs_as_much_in_every_space() -> None:
    """A picture in Oklab is solved as its code values in RGB with a regularity of its scale."""
    picture, space = waves(97, 71), SPACES["oklab"]()
    regularity = OptimizeOptions().regularity * space.scale
    seen = triangulated(picture, "oklab")
    expected = triangulated(
        space.convert(picture), "rgb", optimize=OptimizeOptions(regularity=regularity)
    )
    np.testing.assert_array_equal(seen.mesh.vertices, expected.mesh.vertices)
