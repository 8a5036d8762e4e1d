"""What every layout promises, and what each one is for."""

import numpy as np
import pytest
from scipy.spatial import Delaunay, cKDTree

from stages.layouts import LAYOUTS
from stages.layouts.delaunay import apart_from, delaunay_mesh, earlier_ones
from stages.layouts.grid import Grid
from stages.layouts.importance import Importance
from stages.mesh import Mesh
from stages.validate import assert_valid
from warp_kernels.errors import OptionError

DRAWN = [name for name in LAYOUTS if name != "points"]
"""Layouts that find their points themselves."""
SIZES = [(1, 1), (2, 2), (2, 720), (720, 2), (1, 50), (13, 7), (120, 90)]


def picture(height: int, width: int, seed: int = 0) -> np.ndarray:
    """A dark picture [H, W, 3] uint8 with one bright, noisy disc to the right."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[:height, :width]
    disc = (x - 0.75 * width) ** 2 + (y - 0.5 * height) ** 2 < (0.15 * min(width, height)) ** 2
    noise = rng.integers(0, 256, (height, width, 3))
    return np.where(disc[..., None], noise, 20).astype(np.uint8)


def build(name: str, pixels: np.ndarray, triangle_count: int, seed: int = 0) -> Mesh:
    """Build a layout of the registry with its default parameters."""
    return LAYOUTS[name]().build(pixels, triangle_count, np.random.default_rng(seed))


@pytest.mark.parametrize("triangle_count", [2, 3, 50, 701])
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", DRAWN)
def test_every_layout_is_valid_at_every_size(
    name: str, size: tuple[int, int], triangle_count: int
) -> None:
    """Tiny, narrow and constant pictures get a valid mesh like any other."""
    for pixels in (picture(*size), np.full((*size, 3), 77, dtype=np.uint8)):
        mesh = build(name, pixels, triangle_count)
        assert_valid(mesh)
        assert (mesh.height, mesh.width) == size
        assert mesh.triangle_count >= 2


@pytest.mark.parametrize("name", DRAWN)
def test_every_layout_gives_about_the_wanted_number(name: str) -> None:
    """The number of triangles is met within a tenth, from few to many."""
    for triangle_count in (10, 100, 700, 5000):
        mesh = build(name, picture(90, 120), triangle_count)
        assert mesh.triangle_count == pytest.approx(triangle_count, rel=0.1, abs=3)


@pytest.mark.parametrize("name", DRAWN)
def test_every_layout_depends_on_its_generator_alone(name: str) -> None:
    """Equal generators give equal bits."""
    first, second = (build(name, picture(60, 80), 300, seed=5) for _ in range(2))
    assert np.array_equal(first.vertices, second.vertices)
    assert np.array_equal(first.triangles, second.triangles)


@pytest.mark.parametrize("name", DRAWN)
def test_every_layout_starts_without_slivers(name: str) -> None:
    """No triangle starts thinner than a tenth of the even spacing."""
    mesh = build(name, picture(180, 240), 700)
    spacing = np.sqrt(2 * 180 * 240 / 700)
    assert np.quantile(mesh.heights, 0.02) > 0.1 * spacing
    assert mesh.heights.min() > 0.01 * spacing


def test_grid_has_the_diagonals_of_the_paper() -> None:
    """Every inner vertex has six neighbours and diagonals rise from bottom left to top right."""
    mesh = Grid().build(np.zeros((60, 80, 3), dtype=np.uint8), 24, np.random.default_rng(0))
    assert mesh.triangle_count == 24
    ends = mesh.vertices[mesh.edge_vertices]
    along = ends[:, 1] - ends[:, 0]
    diagonal = along[(along != 0).all(axis=1)]
    assert len(diagonal) == 12
    assert (diagonal[:, 0] * diagonal[:, 1] < 0).all()  # y runs down
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    assert (np.diff(mesh.fan_offsets)[inner] == 6).all()


def test_grid_bases_are_horizontal() -> None:
    """The base edge, from corner 0 to corner 1, keeps its y."""
    mesh = Grid().build(np.zeros((60, 80, 3), dtype=np.uint8), 200, np.random.default_rng(0))
    corners = mesh.vertices[mesh.triangles]
    assert np.array_equal(corners[:, 0, 1], corners[:, 1, 1])


@pytest.mark.parametrize("triangle_count", [2, 3, 10, 101, 700, 1501])
@pytest.mark.parametrize("seed", range(3))
def test_importance_meets_the_number_exactly(triangle_count: int, seed: int) -> None:
    """Where there is room, the number of triangles is the one asked for, even or odd."""
    assert build("importance", picture(90, 120), triangle_count, seed).triangle_count == (
        triangle_count
    )


def test_importance_follows_the_saliency() -> None:
    """The only object in the picture gets several times its share of the inner vertices."""
    mesh = build("importance", picture(180, 240), 1000)
    x, y = mesh.vertices[~(mesh.on_left_right | mesh.on_top_bottom)].T
    near = (x - 180) ** 2 + (y - 90) ** 2 < 35**2
    assert near.mean() > 2 * np.pi * 35**2 / (180 * 240)


def test_importance_follows_the_map_of_the_user() -> None:
    """A map of any size, light on its left half, draws nearly all inner vertices there."""
    halves = np.zeros((3, 8))
    halves[:, :4] = 255
    layout = Importance(importance_map=halves)
    mesh = layout.build(picture(90, 120), 400, np.random.default_rng(1))
    assert_valid(mesh)
    assert mesh.triangle_count == 400
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    assert (mesh.vertices[inner, 0] < 75).mean() > 0.9


def test_importance_serves_a_map_with_a_single_spot() -> None:
    """More vertices than fit into the spot are spread over the rest."""
    spot = np.zeros((90, 120))
    spot[40, 60] = 1.0
    mesh = Importance(importance_map=spot).build(picture(90, 120), 900, np.random.default_rng(2))
    assert_valid(mesh)
    assert mesh.triangle_count == 900


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_importance_refuses_a_map_that_is_none(value: float) -> None:
    """A map that is zero everywhere, negative or not finite is the user's error."""
    layout = Importance(importance_map=np.full((4, 4), value))
    with pytest.raises(OptionError, match="importance map"):
        layout.build(picture(20, 20), 50, np.random.default_rng(0))


@pytest.mark.parametrize("inner", [0, 1, 2, 60, 400])
@pytest.mark.parametrize("along", [0, 1, 7])
def test_triangles_are_those_of_scipy(along: int, inner: int) -> None:
    """Any number of vertices inside and along the border; each of them is used."""
    rng = np.random.default_rng([along, inner])
    sides = [
        np.array([[0, 0], [90, 0], [0, 60], [90, 60]]),
        np.stack([rng.random(along) * 90, np.zeros(along)], axis=1),
        np.stack([np.full(2 * along, 90), rng.random(2 * along) * 60], axis=1),
    ]
    border, inside = np.concatenate(sides), 1 + rng.random((inner, 2)) * (88, 58)
    mesh = delaunay_mesh(border, inside, 90, 60)
    assert_valid(mesh)
    assert np.array_equal(mesh.vertices, np.concatenate([border, inside]))
    if inner:  # without, four vertices lie on a circle
        expected = Delaunay(mesh.vertices).simplices
        flat = {tuple(sorted(row)) for row in expected.tolist() if _area(mesh.vertices[row]) == 0}
        assert _sets(mesh.triangles) == _sets(expected) - flat


def test_a_vertex_between_two_others_is_left_out() -> None:
    """A triangle without area is none."""
    border = np.array([[0, 0], [8, 0], [0, 8], [8, 8]], dtype=np.float64)
    mesh = delaunay_mesh(border, np.array([[4.0, 4.0]]), 8, 8)
    assert_valid(mesh)
    assert mesh.vertex_count == 4


@pytest.mark.parametrize("spacing", [0.01, 3.0, 500.0])
def test_distances_are_those_of_scipy(spacing: float) -> None:
    """Who is too near to others, and of two close ones the later."""
    rng = np.random.default_rng(4)
    points, others = rng.random((2, 200, 2)) * 50
    points[5:9] = points[4]
    known = cKDTree(others).query(points)[0] >= spacing
    assert np.array_equal(apart_from(points, others, spacing), known)
    near = cKDTree(points).query_pairs(spacing, output_type="ndarray")
    expected = np.ones(len(points), dtype=bool)
    expected[near.max(axis=1)] = False
    assert np.array_equal(earlier_ones(points, spacing), expected)


def _area(corners: np.ndarray) -> float:
    """Twice the area of a triangle [px^2]."""
    (a, b), (c, d) = corners[1:] - corners[0]
    return float(a * d - b * c)


def _sets(triangles: np.ndarray) -> set[tuple[int, ...]]:
    """Triangles whatever corner comes first."""
    return {tuple(sorted(row)) for row in triangles.tolist()}
