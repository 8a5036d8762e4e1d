"""Best colours and their errors against least squares in float64."""

from functools import lru_cache

import numpy as np
import pytest

from stages.mesh import mesh_of
from stages.validate import assert_valid
from tests.kernel_samples import (
    delaunay_mesh,
    noise,
    poisoned_workspace,
    random_mesh,
    random_weights,
    snapshot_of,
)
from tests.oracles.coverage import Pixel, covered_pixels, rounded
from tests.oracles.fit import best_fit, exact_energy, is_singular
from tests.oracles.variants import variants
from warp_kernels.color_model import COLOR_MODELS, CONSTANT, LINEAR, QUADRATIC, ColorModel
from warp_kernels.device.device import Device
from warp_kernels.energy.fit import READABLE
from warp_kernels.limits import MAX_SIDE

ENERGY_TOLERANCE = 1e-5
"""Error allowed in an energy [code value^2 px]: rounding of the difference of two sums of about
10^8, with room."""
COLOR_TOLERANCE = 1e-6
"""Error allowed in a colour [code values]."""
MODELS = pytest.mark.parametrize("model", COLOR_MODELS.values(), ids=COLOR_MODELS)
SUMS = pytest.mark.parametrize("sums", ["edges", "fragments"])
WEIGHTED = pytest.mark.parametrize("weighted", [False, True], ids=["plain", "weighted"])


@lru_cache
def variants_by_oracle() -> list[list[list[Pixel]]]:
    """What all variants of the triangles of a mesh over 41 x 33 px cover."""
    mesh = random_mesh(41, 33, 30)
    return [
        [covered_pixels(moved, 41, 33)[1] for moved in variants(corners)]
        for corners in mesh.vertices[mesh.triangles]
    ]


@lru_cache
def energies_by_oracle(model: ColorModel, weighted: bool) -> np.ndarray:
    """Energies of those variants over noise, [T, 13]."""
    weights = random_weights(41, 33) if weighted else None
    energies = [
        [best_fit(noise(41, 33), pixels, model, weights)[1] for pixels in row]
        for row in variants_by_oracle()
    ]
    return np.array(energies) / (weights.mean() if weighted else 1.0)


@MODELS
@SUMS
@WEIGHTED
def test_energies_of_all_variants_equal_the_oracle(
    weighted: bool, sums: str, model: ColorModel, device: str
) -> None:
    """The error of every displaced triangle, also where it leaves the picture or turns over."""
    picture, mesh = noise(41, 33), random_mesh(41, 33, 30)
    weights = random_weights(41, 33) if weighted else None
    actual = poisoned_workspace(Device(device, 1), picture, mesh, model, sums, weights).energies()
    expected = energies_by_oracle(model, weighted)
    np.testing.assert_allclose(actual, expected, rtol=0, atol=ENERGY_TOLERANCE)


@MODELS
@WEIGHTED
@pytest.mark.parametrize("inner", [6, 60, 300])
def test_colors_equal_the_oracle(
    inner: int, weighted: bool, model: ColorModel, device: str
) -> None:
    """The polynomials give the fitted colour at every pixel, as do energies and counts."""
    picture, mesh = noise(45, 31, seed=inner), random_mesh(45, 31, inner, seed=inner)
    weights = random_weights(45, 31) if weighted else None
    factors = np.ones((31, 45), dtype=int) if weights is None else weights.astype(int)
    workspace = poisoned_workspace(Device(device, 1), picture, mesh, model, weights=weights)
    coefficients, energies, counts = workspace.fit()
    powers = np.array(model.exponents)
    for triangle, corners in enumerate(mesh.vertices[mesh.triangles].tolist()):
        _, pixels = covered_pixels([rounded(x, y) for x, y in corners], 45, 31)
        fitted, energy = best_fit(picture, pixels, model, weights)
        assert counts[triangle] == sum(factors[y, x] for x, y in pixels)
        expected = energy / factors.mean()
        assert energies[triangle] == pytest.approx(expected, abs=ENERGY_TOLERANCE)
        terms = ((np.array(pixels).reshape(-1, 1, 2) + 0.5) ** powers).prod(axis=2)
        colors = terms @ coefficients[triangle].T
        np.testing.assert_allclose(colors, fitted, atol=COLOR_TOLERANCE)


@WEIGHTED
def test_more_terms_leave_no_more_energy(weighted: bool, device: str) -> None:
    """Per triangle and variant the quadratic colour is at least as good as the linear one."""
    picture, mesh = noise(61, 47), random_mesh(61, 47, 90, seed=2)
    weights = random_weights(61, 47) if weighted else None
    constant, linear, quadratic = (
        poisoned_workspace(Device(device, 1), picture, mesh, model, weights=weights).energies()
        for model in (CONSTANT, LINEAR, QUADRATIC)
    )
    assert (quadratic <= linear).all()
    assert (linear <= constant).all()
    assert quadratic.sum() < linear.sum() < constant.sum()


def test_weights_draw_the_colour_to_what_counts(device: str) -> None:
    """Where one half of a triangle counts for next to nothing the other half has its colour."""
    picture = np.zeros((20, 20, 3), dtype=np.uint8)
    picture[:, 10:] = 200
    weights = np.where(picture[..., 0] > 0, 255, 1).astype(np.uint8)
    points = np.array([[0, 0], [20, 0], [20, 20], [0, 20]])
    mesh = mesh_of(points, [[0, 1, 3], [1, 2, 3]], 20, 20)
    workspace = poisoned_workspace(Device(device, 1), picture, mesh, CONSTANT, weights=weights)
    coefficients, energies, _ = workspace.fit()
    assert (coefficients[:, :, 0] > 195).all()
    errors = (picture[None] - coefficients[:, None, None, :, 0]) ** 2
    _, pixels = covered_pixels([rounded(x, y) for x, y in points[[0, 1, 3]].tolist()], 20, 20)
    expected = 0.5 * sum(weights[y, x] * errors[0, y, x].sum() for x, y in pixels) / weights.mean()
    assert energies[0] == pytest.approx(expected)


def linear_picture(width: int, height: int) -> np.ndarray:
    """Colours that are exact linear functions of the pixel, [H, W, 3] uint8."""
    y, x = np.mgrid[:height, :width]
    return np.stack([20 + 2 * x + y, 250 - 3 * x, 10 + x + 3 * y], axis=2).astype(np.uint8)


def quadratic_picture(width: int, height: int) -> np.ndarray:
    """Colours that are exact quadratic functions of the pixel, for sides up to 16, [H, W, 3]."""
    y, x = np.mgrid[:height, :width]
    return np.stack([x**2 + y, 255 - x * y - 2 * y, y**2 + x], axis=2).astype(np.uint8)


def plain_picture(width: int, height: int) -> np.ndarray:
    """One colour, [H, W, 3] uint8."""
    return np.broadcast_to(np.array([12, 200, 255], np.uint8), (height, width, 3)).copy()


@pytest.mark.parametrize("model", [LINEAR, QUADRATIC], ids=lambda model: model.name)
@WEIGHTED
def test_polynomial_of_the_degree_has_no_energy(
    weighted: bool, model: ColorModel, device: str
) -> None:
    """A picture that the model can draw leaves no error in any triangle or variant."""
    paint, side = (linear_picture, 47) if model is LINEAR else (quadratic_picture, 16)
    mesh = random_mesh(side, side, 25 if model is LINEAR else 9, seed=3)
    weights = random_weights(side, side) if weighted else None
    workspace = poisoned_workspace(
        Device(device, 1), paint(side, side), mesh, model, weights=weights
    )
    # a displaced triangle whose pixels lie on one line or conic has less to offer
    regular = [_is_regular(c, side, model.degree) for c in mesh.vertices[mesh.triangles]]
    assert sum(regular) > (25 if model is LINEAR else 8)
    assert np.abs(workspace.energies()[regular]).max() < ENERGY_TOLERANCE


@MODELS
def test_plain_picture_has_no_energy(model: ColorModel, device: str) -> None:
    """One colour leaves no error in any triangle or variant, whatever its pixels."""
    mesh = random_mesh(53, 47, 60, seed=3)
    workspace = poisoned_workspace(Device(device, 1), plain_picture(53, 47), mesh, model)
    assert np.abs(workspace.energies()).max() < ENERGY_TOLERANCE


def _is_regular(corners: np.ndarray, side: int, degree: int) -> bool:
    """Whether every variant has a fit of the degree, or no pixel at all."""
    covered = (covered_pixels(moved, side, side)[1] for moved in variants(corners))
    return all(not pixels or not is_singular(pixels, degree) for pixels in covered)


def test_quadratic_colors_are_found_exactly(device: str) -> None:
    """The coefficients are those of the picture, in positions from the upper left corner."""
    mesh = random_mesh(16, 16, 3, seed=4)
    snapshot = snapshot_of(Device(device, 1), quadratic_picture(16, 16), mesh, QUADRATIC)
    large = snapshot.counts > 20
    assert large.sum() > 3
    # with u = x - 1/2, v = y - 1/2: u^2 + v, 255 - u v - 2 v, v^2 + u
    expected = [
        [0.25 - 0.5, -1, 1, 1, 0, 0],
        [255 - 0.25 + 1, 0.5, 0.5 - 2, 0, -1, 0],
        [0.25 - 0.5, 1, -1, 0, 0, 1],
    ]
    for coefficients in snapshot.coefficients[large]:
        np.testing.assert_allclose(coefficients, expected, atol=COLOR_TOLERANCE)


def test_linear_colors_are_found_exactly(device: str) -> None:
    """The coefficients are those of the picture, in positions from the upper left corner."""
    mesh = random_mesh(53, 47, 12, seed=4)
    snapshot = snapshot_of(Device(device, 1), linear_picture(53, 47), mesh, LINEAR)
    large = snapshot.counts > 50
    assert large.sum() > 5
    # pixel (i, j) lies at (i + 1/2, j + 1/2)
    expected = [[20 - 1.5, 2, 1], [250 + 1.5, -3, 0], [10 - 2.0, 1, 3]]
    np.testing.assert_allclose(
        snapshot.coefficients[large],
        np.broadcast_to(expected, (large.sum(), 3, 3)),
        atol=COLOR_TOLERANCE,
    )


@MODELS
@SUMS
def test_triangle_without_pixels(sums: str, model: ColorModel, device: str) -> None:
    """A triangle between pixel centres has no error and a finite colour."""
    points = np.array([[0, 0], [6, 0], [6, 6], [0, 6], [3.1, 3.1], [3.3, 3.1], [3.2, 3.3]])
    mesh = delaunay_mesh(points, 6, 6)
    tiny = int(np.argmin(mesh.areas))
    snapshot = snapshot_of(Device(device, 1), noise(6, 6), mesh, model)
    assert snapshot.counts[tiny] == 0
    assert snapshot.energies[tiny] == 0
    assert np.isfinite(snapshot.coefficients).all()
    energies = poisoned_workspace(Device(device, 1), noise(6, 6), mesh, model, sums).energies()
    assert energies[tiny, 0] == 0
    assert np.isfinite(energies).all()


@pytest.mark.parametrize("model", [LINEAR, QUADRATIC], ids=lambda model: model.name)
@pytest.mark.parametrize("size", [(31, 1), (1, 31)])
def test_pixels_on_a_line_take_the_constant(
    size: tuple[int, int], model: ColorModel, device: str
) -> None:
    """In a picture of one row or column the linear system is singular: the mean colour stays."""
    width, height = size
    points = np.array([[0, 0], [width, 0], [width, height], [0, height]])
    mesh = mesh_of(points, [[0, 1, 3], [1, 2, 3]], width, height)
    picture = noise(width, height)
    sloping = snapshot_of(Device(device, 1), picture, mesh, model)
    constant = snapshot_of(Device(device, 1), picture, mesh, CONSTANT)
    np.testing.assert_array_equal(sloping.coefficients[:, :, 1:], 0.0)
    np.testing.assert_allclose(sloping.coefficients[:, :, 0], constant.coefficients[:, :, 0])
    np.testing.assert_allclose(sloping.energies, constant.energies, rtol=1e-12)


@pytest.mark.parametrize("size", [(31, 2), (2, 31)])
def test_pixels_on_two_lines_take_the_linear_colour(size: tuple[int, int], device: str) -> None:
    """Two rows or columns are a conic: the quadratic system is singular, the linear one is not."""
    width, height = size
    points = np.array([[0, 0], [width, 0], [width, height], [0, height]])
    mesh = mesh_of(points, [[0, 1, 3], [1, 2, 3]], width, height)
    quadratic, linear = (
        snapshot_of(Device(device, 1), noise(width, height), mesh, model)
        for model in (QUADRATIC, LINEAR)
    )
    np.testing.assert_array_equal(quadratic.coefficients[:, :, 3:], 0.0)
    np.testing.assert_array_equal(quadratic.coefficients[:, :, :3], linear.coefficients)
    np.testing.assert_array_equal(quadratic.energies, linear.energies)


def wide_strip(width: int, height: int) -> np.ndarray:
    """Noise on a parabola along a wide picture, [H, W, 3] uint8."""
    x = np.linspace(-1, 1, width)[None, :, None]
    curve = 20 + 180 * x**2 + noise(width, height, seed=3) / 8
    return curve.astype(np.uint8)


@WEIGHTED
def test_far_from_the_middle_sums_wrap_and_fits_do_not(weighted: bool, device: str) -> None:
    """At the ends of the widest picture x^4 leaves 64 bits; the energies are exact all the same."""
    width, height = MAX_SIDE, 80
    points = [[x, y] for x in (0, 600, width // 2, width - 600, width) for y in (0, height)]
    mesh = delaunay_mesh(np.array(points), width, height)
    picture = wide_strip(width, height)
    weights = random_weights(width, height) if weighted else None
    workspace = poisoned_workspace(Device(device, 1), picture, mesh, QUADRATIC, weights=weights)
    # the edge x = 600 has all of x^4 to its left
    column = np.arange(600, dtype=object) - width // 2
    assert height * (column**4).sum() > 2**63
    coefficients, energies, _ = workspace.fit()
    mean = weights.mean() if weighted else 1.0
    for triangle in np.flatnonzero(mesh.areas < 30_000)[1:3]:
        corners = mesh.vertices[mesh.triangles[triangle]].tolist()
        _, pixels = covered_pixels([rounded(x, y) for x, y in corners], width, height)
        expected = exact_energy(picture, pixels, QUADRATIC, weights) / mean
        assert energies[triangle] == pytest.approx(expected, rel=1e-9)
        terms = (np.array(pixels)[:, None, :] + 0.5) ** np.array(QUADRATIC.exponents)
        drawn = terms.prod(axis=2) @ coefficients[triangle].T
        fitted, _ = best_fit(picture, pixels, QUADRATIC, weights)
        np.testing.assert_allclose(drawn, fitted, atol=COLOR_TOLERANCE)


def test_triangle_too_large_for_fourth_powers_takes_the_linear_colour(device: str) -> None:
    """Across the whole of the widest picture x^4 cannot be read; the picture is not refused."""
    width, height = MAX_SIDE, 80
    points = np.array([[0, 0], [width, 0], [width, height], [0, height]])
    mesh = mesh_of(points, [[0, 1, 3], [1, 2, 3]], width, height)
    quadratic, linear = (
        snapshot_of(Device(device, 1), wide_strip(width, height), mesh, model)
        for model in (QUADRATIC, LINEAR)
    )
    np.testing.assert_array_equal(quadratic.coefficients[:, :, 3:], 0.0)
    np.testing.assert_array_equal(quadratic.energies, linear.energies)


@pytest.mark.parametrize("size", [(3840, 2160), (2160, 3840)])
def test_bound_on_fourth_powers_is_true(size: tuple[int, int]) -> None:
    """Right triangles of all widths in a large picture: below the bound the sum is readable."""
    width, height = size
    for side in range(100, width, 200):
        rows = np.linspace(height, 0, side, dtype=np.int64)
        x = np.arange(side, dtype=object) - side // 3
        second, fourth = (int((rows * x**power).sum()) for power in (2, 4))
        for reach in (width // 2, width):
            if second * reach**2 < READABLE and side <= 2 * reach:
                assert fourth < 2**63
        if width == 3840 and side <= 1100:
            assert second * width**2 < READABLE


def test_pixels_on_a_slanted_line_take_the_constant(device: str) -> None:
    """A needle that covers a diagonal of pixels falls back too, wherever it lies."""
    corners = [[0, 0], [40, 0], [40, 40], [0, 40]]
    points = np.array([*corners, [10, 10.2], [30, 30.1], [20, 19.8]])
    above, below = [[0, 1, 4], [1, 6, 4], [1, 5, 6], [1, 2, 5]], [[0, 4, 3], [4, 5, 3], [5, 2, 3]]
    mesh = mesh_of(points, [[4, 6, 5], *above, *below], 40, 40)
    assert_valid(mesh)
    snapshot = snapshot_of(Device(device, 1), noise(40, 40), mesh, LINEAR)
    assert snapshot.counts[0] > 10
    np.testing.assert_array_equal(snapshot.coefficients[0, :, 1:], 0.0)
    assert (snapshot.coefficients[1:, :, 1:] != 0.0).all()


@MODELS
def test_energies_do_not_depend_on_the_order_of_triangles(model: ColorModel, device: str) -> None:
    """Shuffled rows give the same bits, in the shuffled order."""
    picture, mesh = noise(45, 31), random_mesh(45, 31, 60)
    order = np.random.default_rng(5).permutation(mesh.triangle_count)
    shuffled = mesh_of(mesh.vertices, mesh.triangles[order], 45, 31)
    before = poisoned_workspace(Device(device, 1), picture, mesh, model).energies()
    after = poisoned_workspace(Device(device, 1), picture, shuffled, model).energies()
    np.testing.assert_array_equal(after, before[order])


@MODELS
def test_mirrored_picture_has_the_mirrored_energies(model: ColorModel, device: str) -> None:
    """Left and right exchanged: the same errors, moved right and moved left exchanged."""
    picture, mesh = noise(45, 31), random_mesh(45, 31, 60)
    flipped = (mesh.vertices - np.array([45, 0])) * (-1, 1)
    mirrored = mesh_of(flipped, mesh.triangles[:, [0, 2, 1]], 45, 31)
    before = poisoned_workspace(Device(device, 1), picture, mesh, model).energies()
    after = poisoned_workspace(
        Device(device, 1), picture[:, ::-1].copy(), mirrored, model
    ).energies()
    order = [0, 2, 1, 3, 4, 10, 9, 11, 12, 6, 5, 7, 8]
    np.testing.assert_allclose(after, before[:, order], atol=ENERGY_TOLERANCE)


@MODELS
def test_shifted_picture_has_the_same_energies(model: ColorModel, device: str) -> None:
    """A whole number of pixels further the errors are the same; with constant colours, the bits."""
    larger = noise(60, 50)
    mesh = random_mesh(40, 30, 60, grid=256)
    # a displaced corner must stay in the smaller picture
    inside = ((mesh.vertices > 1) & (mesh.vertices < (39, 29))).all(axis=1)
    kept = inside[mesh.triangles].all(axis=1)
    here = poisoned_workspace(Device(device, 1), larger[7:37, 11:51].copy(), mesh, model).energies()
    wide = mesh_of(mesh.vertices + np.array([11, 7]), mesh.triangles, 60, 50)
    there = poisoned_workspace(Device(device, 1), larger, wide, model).energies()
    tolerance = 0.0 if model is CONSTANT else ENERGY_TOLERANCE
    np.testing.assert_allclose(there[kept], here[kept], rtol=0, atol=tolerance)
