"""Best colours and their errors against least squares in float64."""

import numpy as np
import pytest

from stages.mesh import mesh_of
from stages.validate import assert_valid
from tests.kernel_samples import delaunay_mesh, noise, poisoned_workspace, random_mesh, snapshot_of
from tests.oracles.coverage import covered_pixels, rounded
from tests.oracles.fit import best_fit, is_singular
from tests.oracles.variants import variants
from warp_kernels.color_model import COLOR_MODELS, CONSTANT, LINEAR, ColorModel
from warp_kernels.device import Device

ENERGY_TOLERANCE = 1e-5
"""Error allowed in an energy [code value^2 px]: rounding of the difference of two sums of about
10^8, with room."""
COLOR_TOLERANCE = 1e-6
"""Error allowed in a colour [code values]."""
MODELS = pytest.mark.parametrize("model", COLOR_MODELS.values(), ids=COLOR_MODELS)
SUMS = pytest.mark.parametrize("sums", ["edges", "fragments"])


@MODELS
@SUMS
def test_energies_of_all_variants_equal_the_oracle(
    sums: str, model: ColorModel, device: str
) -> None:
    """The error of every displaced triangle, also where it leaves the picture or turns over."""
    picture, mesh = noise(41, 33), random_mesh(41, 33, 50)
    actual = poisoned_workspace(Device(device), picture, mesh, model, sums).energies()
    for triangle, corners in enumerate(mesh.vertices[mesh.triangles]):
        for variant, moved in enumerate(variants(corners)):
            _, pixels = covered_pixels(moved, 41, 33)
            _, expected = best_fit(picture, pixels, model)
            assert actual[triangle, variant] == pytest.approx(expected, abs=ENERGY_TOLERANCE)


@MODELS
@pytest.mark.parametrize("inner", [6, 60, 600])
def test_colors_equal_the_oracle(inner: int, model: ColorModel, device: str) -> None:
    """The polynomials give the fitted colour at every pixel, as do energies and counts."""
    picture, mesh = noise(45, 31, seed=inner), random_mesh(45, 31, inner, seed=inner)
    snapshot = snapshot_of(Device(device), picture, mesh, model)
    powers = np.array(model.exponents)
    for triangle, corners in enumerate(mesh.vertices[mesh.triangles].tolist()):
        _, pixels = covered_pixels([rounded(x, y) for x, y in corners], 45, 31)
        fitted, energy = best_fit(picture, pixels, model)
        assert snapshot.counts[triangle] == len(pixels)
        assert snapshot.energies[triangle] == pytest.approx(energy, abs=ENERGY_TOLERANCE)
        terms = ((np.array(pixels).reshape(-1, 1, 2) + 0.5) ** powers).prod(axis=2)
        colors = terms @ snapshot.coefficients[triangle].T
        np.testing.assert_allclose(colors, fitted, atol=COLOR_TOLERANCE)


def linear_picture(width: int, height: int) -> np.ndarray:
    """Colours that are exact linear functions of the pixel, [H, W, 3] uint8."""
    y, x = np.mgrid[:height, :width]
    return np.stack([20 + 2 * x + y, 250 - 3 * x, 10 + x + 3 * y], axis=2).astype(np.uint8)


def plain_picture(width: int, height: int) -> np.ndarray:
    """One colour, [H, W, 3] uint8."""
    return np.broadcast_to(np.array([12, 200, 255], np.uint8), (height, width, 3)).copy()


@pytest.mark.parametrize(
    ("model", "paint"),
    [(CONSTANT, plain_picture), (LINEAR, plain_picture), (LINEAR, linear_picture)],
)
def test_polynomial_of_the_degree_has_no_energy(model: ColorModel, paint, device: str) -> None:
    """A picture that the model can draw leaves no error in any triangle or variant."""
    mesh = random_mesh(53, 47, 60, seed=3)
    workspace = poisoned_workspace(Device(device), paint(53, 47), mesh, model)
    energies = workspace.energies()
    if paint is linear_picture:
        # a displaced triangle whose pixels lie on one line has the constant to offer
        energies = energies[[_is_regular(corners) for corners in mesh.vertices[mesh.triangles]]]
        assert len(energies) > 60
    assert np.abs(energies).max() < ENERGY_TOLERANCE


def _is_regular(corners: np.ndarray) -> bool:
    """Whether every variant has a linear fit, or no pixel at all."""
    covered = (covered_pixels(moved, 53, 47)[1] for moved in variants(corners))
    return all(not pixels or not is_singular(pixels) for pixels in covered)


def test_linear_colors_are_found_exactly(device: str) -> None:
    """The coefficients are those of the picture, in positions from the upper left corner."""
    mesh = random_mesh(53, 47, 12, seed=4)
    snapshot = snapshot_of(Device(device), linear_picture(53, 47), mesh, LINEAR)
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
    snapshot = snapshot_of(Device(device), noise(6, 6), mesh, model)
    assert snapshot.counts[tiny] == 0
    assert snapshot.energies[tiny] == 0
    assert np.isfinite(snapshot.coefficients).all()
    energies = poisoned_workspace(Device(device), noise(6, 6), mesh, model, sums).energies()
    assert energies[tiny, 0] == 0
    assert np.isfinite(energies).all()


@pytest.mark.parametrize("size", [(31, 1), (1, 31)])
def test_pixels_on_a_line_take_the_constant(size: tuple[int, int], device: str) -> None:
    """In a picture of one row or column the linear system is singular: the mean colour stays."""
    width, height = size
    points = np.array([[0, 0], [width, 0], [width, height], [0, height]])
    mesh = mesh_of(points, [[0, 1, 3], [1, 2, 3]], width, height)
    picture = noise(width, height)
    linear = snapshot_of(Device(device), picture, mesh, LINEAR)
    constant = snapshot_of(Device(device), picture, mesh, CONSTANT)
    np.testing.assert_array_equal(linear.coefficients[:, :, 1:], 0.0)
    np.testing.assert_allclose(linear.coefficients[:, :, 0], constant.coefficients[:, :, 0])
    np.testing.assert_allclose(linear.energies, constant.energies, rtol=1e-12)


def test_pixels_on_a_slanted_line_take_the_constant(device: str) -> None:
    """A needle that covers a diagonal of pixels falls back too, wherever it lies."""
    corners = [[0, 0], [40, 0], [40, 40], [0, 40]]
    points = np.array([*corners, [10, 10.2], [30, 30.1], [20, 19.8]])
    above, below = [[0, 1, 4], [1, 6, 4], [1, 5, 6], [1, 2, 5]], [[0, 4, 3], [4, 5, 3], [5, 2, 3]]
    mesh = mesh_of(points, [[4, 6, 5], *above, *below], 40, 40)
    assert_valid(mesh)
    snapshot = snapshot_of(Device(device), noise(40, 40), mesh, LINEAR)
    assert snapshot.counts[0] > 10
    np.testing.assert_array_equal(snapshot.coefficients[0, :, 1:], 0.0)
    assert (snapshot.coefficients[1:, :, 1:] != 0.0).all()


@MODELS
def test_energies_do_not_depend_on_the_order_of_triangles(model: ColorModel, device: str) -> None:
    """Shuffled rows give the same bits, in the shuffled order."""
    picture, mesh = noise(45, 31), random_mesh(45, 31, 60)
    order = np.random.default_rng(5).permutation(mesh.triangle_count)
    shuffled = mesh_of(mesh.vertices, mesh.triangles[order], 45, 31)
    before = poisoned_workspace(Device(device), picture, mesh, model).energies()
    after = poisoned_workspace(Device(device), picture, shuffled, model).energies()
    np.testing.assert_array_equal(after, before[order])


@MODELS
def test_mirrored_picture_has_the_mirrored_energies(model: ColorModel, device: str) -> None:
    """Left and right exchanged: the same errors, moved right and moved left exchanged."""
    picture, mesh = noise(45, 31), random_mesh(45, 31, 60)
    flipped = (mesh.vertices - np.array([45, 0])) * (-1, 1)
    mirrored = mesh_of(flipped, mesh.triangles[:, [0, 2, 1]], 45, 31)
    before = poisoned_workspace(Device(device), picture, mesh, model).energies()
    after = poisoned_workspace(Device(device), picture[:, ::-1].copy(), mirrored, model).energies()
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
    here = poisoned_workspace(Device(device), larger[7:37, 11:51].copy(), mesh, model).energies()
    wide = mesh_of(mesh.vertices + np.array([11, 7]), mesh.triangles, 60, 50)
    there = poisoned_workspace(Device(device), larger, wide, model).energies()
    tolerance = 0.0 if model is CONSTANT else ENERGY_TOLERANCE
    np.testing.assert_allclose(there[kept], here[kept], rtol=0, atol=tolerance)
