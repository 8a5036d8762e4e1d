"""Integer sums: `edges`, `fragments` and exact arithmetic agree to the bit."""

from functools import lru_cache

import numpy as np
import pytest
import warp as wp

from stages.mesh import Mesh, mesh_of
from tests.kernel_samples import (
    POISON,
    noise,
    poisoned_workspace,
    random_mesh,
    random_weights,
)
from tests.oracles.coverage import Pixel, covered_pixels
from tests.oracles.moments import moments
from tests.oracles.variants import variants
from warp_kernels.color_model import COLOR_MODELS, CONSTANT, LINEAR, ColorModel
from warp_kernels.device.device import Device
from warp_kernels.energy.fit import READABLE
from warp_kernels.energy.workspace import Workspace
from warp_kernels.errors import OptionError
from warp_kernels.limits import MAX_SIDE
from warp_kernels.moments.moment_layout import MomentLayout, layout_of_moments, moment_types
from warp_kernels.moments.pixel_moments import check_size
from warp_kernels.moments.prefix_tables import BLOCK_ROWS, record_image_tables, table_length
from warp_kernels.moments.variants import DIRECTIONS, TRIANGLE_VARIANTS

Sums = tuple[np.ndarray, np.ndarray]
"""Colour moments [T, 13, 4 K] and area moments [T, 13, G]."""

MODELS = pytest.mark.parametrize("model", COLOR_MODELS.values(), ids=COLOR_MODELS)
WEIGHTED = pytest.mark.parametrize("weighted", [False, True], ids=["plain", "weighted"])
CASES = {
    "random": (37, 29, 30, 0),
    "crowded": (13, 11, 60, 0),
    "half_pixels": (21, 15, 40, 2),
    "one_pixel": (1, 1, 3, 0),
    "column": (1, 63, 12, 0),
    "row": (65, 1, 12, 0),
}
"""Width, height, inner points, and the grid on which points lie."""


@lru_cache
def sample(name: str) -> tuple[np.ndarray, Mesh]:
    """A picture of noise and a mesh over it."""
    width, height, inner, grid = CASES[name]
    return noise(width, height, seed=inner), random_mesh(width, height, inner, grid=grid)


def weights_of(picture: np.ndarray, weighted: bool) -> np.ndarray | None:
    """Weights for a picture, or none."""
    return random_weights(picture.shape[1], picture.shape[0]) if weighted else None


@lru_cache
def covered_by_oracle(name: str) -> list[tuple[int, list[Pixel]]]:
    """Sign and pixels of all variants of all triangles."""
    _, mesh = sample(name)
    return [
        covered_pixels(corners, mesh.width, mesh.height)
        for triangle in mesh.vertices[mesh.triangles]
        for corners in variants(triangle)
    ]


@lru_cache
def sums_by_oracle(name: str, model: ColorModel, weighted: bool) -> Sums:
    """The moments of all variants, pixel by pixel."""
    picture, mesh = sample(name)
    weights = weights_of(picture, weighted)
    rows = [
        moments(picture, pixels, model, sign, weights) for sign, pixels in covered_by_oracle(name)
    ]
    color, area = (np.array(part, dtype=np.int64) for part in zip(*rows, strict=True))
    shape = (mesh.triangle_count, TRIANGLE_VARIANTS, -1)
    return color.reshape(shape), area.reshape(shape)


def sums_by_kernel(workspace: Workspace, mesh: Mesh) -> Sums:
    """The moments of all variants, gathered from the sides if they were summed along edges."""
    color, area = workspace.moments()
    if workspace.sums == "fragments":
        return color, area
    return gathered(mesh, color), gathered(mesh, area)


def gathered(mesh: Mesh, edge_sums: np.ndarray) -> np.ndarray:
    """Sums of triangles, [T, 13, M], from those of edges, [E, M, 9]."""
    edges = mesh.half_edge_to_edge.reshape(-1, 3)
    backwards = mesh.half_edge_reversed.reshape(-1, 3).astype(int)
    total = np.zeros((mesh.triangle_count, TRIANGLE_VARIANTS, edge_sums.shape[1]), dtype=np.int64)
    for variant in range(TRIANGLE_VARIANTS):
        moved, direction = divmod(variant - 1, DIRECTIONS)
        for side in range(3):
            version = np.zeros_like(edges[:, side])
            if moved in (side, (side + 1) % 3):
                end = backwards[:, side] ^ int(moved != side)
                version = 1 + DIRECTIONS * end + direction
            sums = edge_sums[edges[:, side], :, version]
            total[:, variant] += (1 - 2 * backwards[:, side])[:, None] * sums
    return total


@MODELS
@WEIGHTED
@pytest.mark.parametrize("name", CASES)
def test_both_sums_equal_the_oracle(
    name: str, weighted: bool, model: ColorModel, device: str
) -> None:
    """All thirteen variants, all moments, one to three threads: the same integers."""
    picture, mesh = sample(name)
    weights = weights_of(picture, weighted)
    expected = sums_by_oracle(name, model, weighted)
    for sums in ("edges", "fragments"):
        for threads in (1, 2, 3):
            workspace = poisoned_workspace(
                Device(device, threads), picture, mesh, model, sums, weights
            )
            for actual, wanted in zip(sums_by_kernel(workspace, mesh), expected, strict=True):
                np.testing.assert_array_equal(actual, wanted, f"{sums}, {threads} threads")


@MODELS
@WEIGHTED
@pytest.mark.parametrize("seed", range(2))
def test_edges_equal_fragments_on_larger_meshes(
    seed: int, weighted: bool, model: ColorModel, device: str
) -> None:
    """Three hundred triangles over 211 x 133 px, more threads than cores."""
    picture, mesh = noise(211, 133, seed), random_mesh(211, 133, 150, seed=seed)
    weights = weights_of(picture, weighted)
    workspaces = [
        poisoned_workspace(Device(device, 3), picture, mesh, model, sums, weights)
        for sums in ("edges", "fragments")
    ]
    results = [sums_by_kernel(workspace, mesh) for workspace in workspaces]
    for edges, fragments in zip(*results, strict=True):
        np.testing.assert_array_equal(edges, fragments)


@pytest.mark.parametrize("sums", ["edges", "fragments"])
def test_corner_displaced_out_of_the_picture(sums: str, device: str) -> None:
    """What leaves the picture adds nothing; all thirteen counts by hand."""
    mesh = mesh_of(np.array([[0, 0], [4, 0], [4, 4], [0, 4]]), [[0, 1, 3], [1, 2, 3]], 4, 4)
    white = np.full((4, 4, 3), 255, dtype=np.uint8)
    workspace = poisoned_workspace(Device(device), white, mesh, CONSTANT, sums)
    _, area = sums_by_kernel(workspace, mesh)
    # itself; corner (0, 0) moved right, left, down, up; then (4, 0); then (0, 4)
    assert area[0, :, 0].tolist() == [6, 4, 6, 4, 6, 10, 6, 8, 6, 8, 6, 10, 6]


@MODELS
@WEIGHTED
def test_triangles_add_up_to_the_picture(weighted: bool, model: ColorModel, device: str) -> None:
    """The moments of all triangles together are those of the whole picture."""
    picture, mesh = sample("random")
    weights = weights_of(picture, weighted)
    everything = [(x, y) for y in range(mesh.height) for x in range(mesh.width)]
    workspace = poisoned_workspace(Device(device), picture, mesh, model, weights=weights)
    expected = moments(picture, everything, model, weights=weights)
    for actual, wanted in zip(sums_by_kernel(workspace, mesh), expected, strict=True):
        assert actual[:, 0].sum(axis=0).tolist() == wanted


@MODELS
@pytest.mark.parametrize("weight", [0, 1, 7, 255])
def test_equal_weights_are_no_weights(weight: int, model: ColorModel, device: str) -> None:
    """Whatever weight all pixels have: sums, energies and colours to the bit."""
    picture, mesh = sample("random")
    equal = np.full(picture.shape[:2], weight, dtype=np.uint8)
    plain, weighted = (
        poisoned_workspace(Device(device), picture, mesh, model, weights=weights)
        for weights in (None, equal)
    )
    for read in (Workspace.moments, Workspace.fit, lambda workspace: [workspace.energies()]):
        for with_weights, without in zip(read(weighted), read(plain), strict=True):
            np.testing.assert_array_equal(with_weights, without)


def test_weights_that_do_not_fit_are_refused(device: str) -> None:
    """Of another size or type, or where none are expected."""
    picture = noise(5, 4)
    weighted = Workspace(Device(device), (5, 4), CONSTANT, weighted=True)
    for wrong in (np.ones((5, 4), np.uint8), np.ones((4, 5))):
        with pytest.raises(ValueError, match="must be"):
            weighted.load_image(picture, wrong)
    with pytest.raises(ValueError, match="weighted=True"):
        Workspace(Device(device), (5, 4), CONSTANT).load_image(picture, np.ones((4, 5), np.uint8))


def prefix_table(
    picture: np.ndarray, layout: MomentLayout, device: Device, weights: np.ndarray
) -> np.ndarray:
    """The kernel's table without its blocks, [H, W + 1, depth, 4]."""
    height, width = picture.shape[:2]
    length = table_length(width, height, layout)
    table = wp.full(length, POISON, dtype=moment_types(layout).entry, device=device.warp)
    pixels = wp.array(picture, dtype=wp.vec3ub, device=device.warp)
    factors = wp.array(weights, dtype=wp.uint8, device=device.warp)
    phase = record_image_tables(device, layout, pixels=pixels, weights=factors, table_out=table)
    device.run([phase])
    blocks = table.numpy().reshape(-1, width + 1, BLOCK_ROWS, layout.depth, 4)
    rows = blocks.swapaxes(1, 2).reshape(-1, width + 1, layout.depth, 4)[:height]
    return rows.view(np.int64) if layout.wide else rows


def prefix_sums(picture: np.ndarray, layout: MomentLayout, weights: np.ndarray) -> np.ndarray:
    """The same by NumPy, int64, modulo 2^64."""
    height, width = picture.shape[:2]
    values = picture.astype(np.int64)
    x = (np.arange(width) - width // 2)[None, :, None]
    factor = weights.astype(np.int64)[:, :, None] if layout.wide else np.ones_like(x)
    table = np.zeros((height, width + 1, layout.depth, 4), dtype=np.int64)
    for power in range(layout.model.degree + 1):
        table[:, 1:, power, :3] = np.cumsum(factor * x**power * values, axis=1)
    table[:, 1:, 0, 3] = np.cumsum((factor * values**2).sum(axis=2), axis=1)
    for power, word in enumerate(layout.area_words if layout.wide else ()):
        table[:, 1:, word // 4, word % 4] = np.cumsum((factor * x**power)[:, :, 0], axis=1)
    return table


@MODELS
@WEIGHTED
@pytest.mark.parametrize("size", [(1, 1), (2, 3), (61, 37), (64, 1)])
def test_prefix_tables_are_cumulative_sums(
    size: tuple[int, int], weighted: bool, model: ColorModel, device: str
) -> None:
    """Every entry of the table equals NumPy's cumulative sum; what nobody reads is 0."""
    picture, weights = noise(*size), random_weights(*size)
    layout = layout_of_moments(model, weighted=weighted)
    for threads in (1, 2):
        actual = prefix_table(picture, layout, Device(device, threads), weights)
        np.testing.assert_array_equal(actual, prefix_sums(picture, layout, weights))


def test_largest_prefix_sums_fit_int32(device: str) -> None:
    """A white row of the largest width gives exact entries, the analytic worst case below 2^31."""
    white, ones = np.full((1, MAX_SIDE, 3), 255, dtype=np.uint8), np.ones((1, MAX_SIDE), np.uint8)
    layout = layout_of_moments(LINEAR)
    expected = prefix_sums(white, layout, ones)
    assert np.abs(expected).max() == 255 * sum(range(MAX_SIDE // 2 + 1)) < 2**31
    assert expected[..., 0, 3].max() == 3 * 255**2 * MAX_SIDE < 2**31
    np.testing.assert_array_equal(prefix_table(white, layout, Device(device), ones), expected)


@pytest.mark.parametrize("model", [CONSTANT, LINEAR], ids=lambda model: model.name)
def test_largest_narrow_sums_over_rows_fit_int64(model: ColorModel) -> None:
    """Centring multiplies by sides at most: all stays below 2^63 for the largest picture."""
    pixels = MAX_SIDE**2
    powers = max(a + b for a, b in model.area_exponents)
    # binomial shift: at most 4 terms of one sum times the distances moved, each below 2 sides
    assert 4 * (2 * MAX_SIDE) ** powers * pixels < 2**63
    assert 4 * (2 * MAX_SIDE) ** model.degree * 255 * pixels < 2**63
    assert 3 * 255**2 * pixels < 2**63


def test_largest_wide_sums_that_must_not_wrap() -> None:
    """Whatever the weights: what the linear colour needs, before and after centring."""
    weight, pixels, half = 255, MAX_SIDE**2, MAX_SIDE // 2
    assert weight * pixels * half**2 < 2**63
    assert weight * pixels * MAX_SIDE**2 < 2**63
    assert weight * 255 * pixels * MAX_SIDE < 2**63
    assert weight * 3 * 255**2 * pixels < 2**63
    # the right-hand sides of x^2: 255 times a sum of w x^2 that is readable beside its reach
    assert 255 * READABLE / 16**2 < 2**63


@MODELS
@pytest.mark.parametrize("size", [(MAX_SIDE, 1), (1, MAX_SIDE)])
def test_largest_sides_sum_exactly(size: tuple[int, int], model: ColorModel, device: str) -> None:
    """Two triangles over a white line of the largest length, in closed form."""
    width, height = size
    points = np.array([[0, 0], [width, 0], [width, height], [0, height]])
    mesh = mesh_of(points, [[0, 1, 3], [1, 2, 3]], width, height)
    white = np.full((height, width, 3), 255, dtype=np.uint8)
    workspace = poisoned_workspace(Device(device), white, mesh, model)
    color, area = (part[:, 0].sum(axis=0).tolist() for part in sums_by_kernel(workspace, mesh))
    x = range(-(width // 2), width - width // 2)
    y = range(-(height // 2), height - height // 2)
    for n, (a, b) in enumerate(model.area_exponents):
        assert area[n] == sum(i**a for i in x) * sum(j**b for j in y)
    for n, (a, b) in enumerate(model.exponents):
        assert color[4 * n] == 255 * sum(i**a for i in x) * sum(j**b for j in y)
    assert color[3] == 3 * 255**2 * MAX_SIDE


def test_larger_pictures_are_refused() -> None:
    """One pixel more than the sums allow is an error that names the limit."""
    check_size(MAX_SIDE, MAX_SIDE)
    for size in ((MAX_SIDE + 1, 1), (1, MAX_SIDE + 1)):
        with pytest.raises(OptionError, match=str(MAX_SIDE)):
            check_size(*size)
