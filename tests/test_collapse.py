"""Slivers go, everything else stays."""

import numpy as np
import pytest
from meshes import random_mesh, scrambled, two_triangles

from stages.edits import split_edges, split_triangles
from stages.mesh import mesh_of
from stages.topology.collapse_slivers import collapse_slivers
from stages.validate import assert_valid


@pytest.mark.parametrize("seed", range(8))
def test_slivers_of_scrambled_meshes_go(seed: int) -> None:
    """Nearly all thin triangles of a badly shaped mesh vanish and the mesh stays valid."""
    mesh = scrambled(random_mesh(seed, inner=250), seed)
    before = (mesh.heights < 1.0).sum()
    collapsed = collapse_slivers(mesh, 1.0)
    assert_valid(collapsed)
    assert before > 20
    assert (collapsed.heights < 1.0).sum() <= 0.05 * before
    assert collapsed.triangle_count < mesh.triangle_count


@pytest.mark.parametrize("seed", range(3))
def test_small_areas_go_as_well(seed: int) -> None:
    """Triangles below an area go although they are not thin."""
    mesh = random_mesh(seed)
    parent = int(mesh.areas.argmax())
    crowded = split_triangles(mesh, [parent])
    for _ in range(3):
        crowded = split_triangles(crowded, [crowded.triangle_count - 1])
    small = (crowded.areas < 3.0).sum()
    collapsed = collapse_slivers(crowded, 0.0, min_area=3.0)
    assert_valid(collapsed)
    assert small >= 3
    assert (collapsed.areas < 3.0).sum() <= 1


def test_a_mesh_without_slivers_comes_back_as_it_is() -> None:
    """Nothing to do returns the same object."""
    mesh = two_triangles()
    assert collapse_slivers(mesh, 1.0, 1.0) is mesh


def test_a_needle_collapses_on_its_short_edge() -> None:
    """Two vertices 0.01 px apart become one."""
    mesh = split_triangles(two_triangles(), [0])
    inner = mesh.vertices[4]
    child = int(np.flatnonzero((mesh.triangles == 4).any(axis=1))[0])
    corners = mesh.vertices[mesh.triangles[child]]
    beside = inner + 0.01 * (corners.mean(axis=0) - inner)
    needle = split_triangles(mesh, [child], [beside])
    collapsed = collapse_slivers(needle, 0.1)
    assert_valid(collapsed)
    assert collapsed.vertex_count == 5
    assert collapsed.heights.min() > 0.5


def test_a_cap_on_the_border_goes() -> None:
    """A vertex a hair above the border cannot be flipped away and is collapsed."""
    mesh = split_triangles(two_triangles(), [0], [(2.0, 0.01)])
    collapsed = collapse_slivers(mesh, 0.1)
    assert_valid(collapsed)
    assert collapsed.heights.min() >= 0.1


def test_corners_survive_any_threshold() -> None:
    """Even when every triangle counts as a sliver the four corners and the domain remain."""
    collapsed = collapse_slivers(random_mesh(0), 1e6, 1e9)
    assert_valid(collapsed)
    assert collapsed.vertex_count >= 4


def test_a_flip_mends_what_no_collapse_can() -> None:
    """A cap between two border vertices of different sides is flipped, not collapsed."""
    points = np.array([[0, 0], [10, 0], [10, 10], [0, 10], [5.0, 0], [10, 5.0]])
    # The cap (4, 5, 1) is fine; the flat one is (4, 6, 5) with 6 just off the chord 4 - 5.
    points = np.concatenate([points, [[7.45, 2.55]]])
    triangles = [[4, 1, 5], [4, 5, 6], [0, 4, 6], [0, 6, 3], [6, 2, 3], [6, 5, 2]]
    mesh = mesh_of(points, triangles, 10, 10)
    assert_valid(mesh)
    collapsed = collapse_slivers(mesh, 0.5)
    assert_valid(collapsed)
    assert collapsed.heights.min() >= 0.5


def test_a_row_of_slivers_along_an_edge_goes() -> None:
    """Many midpoints on one border edge, closer than the threshold, are thinned out."""
    mesh = two_triangles()
    for _ in range(6):
        mesh = split_edges(mesh, [int(np.flatnonzero(mesh.twins < 0)[0])])
    collapsed = collapse_slivers(mesh, 0.2)
    assert_valid(collapsed)
    assert collapsed.heights.min() >= 0.2


def test_flat_triangle_on_the_border_is_pressed_onto_it() -> None:
    """The bug that left wedges at the picture's rim: an inner vertex could not join the border."""
    points = np.array([[0, 0], [20, 0], [20, 20], [0, 20], [9, 0.3]])
    rows = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
    mesh = mesh_of(points, rows, 20, 20)
    mended = collapse_slivers(mesh, 0.5)
    assert_valid(mended)
    assert mended.triangle_count == 3
    np.testing.assert_array_equal(mended.vertices[4], (9, 0))
    np.testing.assert_array_equal(mended.vertex_ids, mesh.vertex_ids)
    np.testing.assert_array_equal(mended.triangle_ids, mesh.triangle_ids[1:])
    assert mended.on_top_bottom[4]
