"""Edits of the mesh: valid results, ids, rows, and the sets they accept and refuse."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import random_mesh, scrambled, triangle_set, two_triangles

from stages.edits import (
    collapse_edges,
    collapsible,
    flip_edges,
    flippable,
    independent_collapses,
    independent_flips,
    press_onto_border,
    pressable,
    split_edges,
    split_triangles,
    turn_base_edge,
)
from stages.edits.neighbourhood import edge_ends, edge_triangles, stars
from stages.mesh import Mesh, areas_of, mesh_of, twins_of
from stages.validate import assert_valid


def unchanged_rows(before: Mesh, after: Mesh) -> np.ndarray:
    """Old triangles that have the same corners in the same order under the same id."""
    rows = dict(
        zip(after.triangle_ids.tolist(), after.vertex_ids[after.triangles].tolist(), strict=True)
    )
    old = zip(before.triangle_ids.tolist(), before.vertex_ids[before.triangles], strict=True)
    return np.flatnonzero([rows.get(number) == corners.tolist() for number, corners in old])


def assert_largest_child_goes_on(before: Mesh, after: Mesh, parents: np.ndarray) -> None:
    """The largest child of each split triangle has its id, the others fresh ones."""
    centres = after.vertices[after.triangles].mean(axis=1)
    fresh = after.triangle_ids >= before.next_triangle_id
    for parent in parents:
        children = np.flatnonzero(is_inside(centres, before.vertices[before.triangles[parent]]))
        (heir,) = children[~fresh[children]]
        assert after.triangle_ids[heir] == before.triangle_ids[parent]
        assert after.areas[heir] == after.areas[children].max()


def is_inside(points: np.ndarray, triangle: np.ndarray) -> np.ndarray:
    """Which points lie in a triangle of positive area."""
    sides = [
        areas_of(np.stack(np.broadcast_arrays(triangle[i], triangle[i - 2], points), axis=1))
        for i in range(3)
    ]
    return (np.array(sides) > 0).all(axis=0)


# Splits


def test_split_triangle_makes_three_children_of_a_third_each() -> None:
    """The centroid cuts a triangle into thirds; the other triangle keeps its row and id."""
    mesh = two_triangles()
    split = split_triangles(mesh, [1])
    assert_valid(split)
    assert split.areas.tolist() == pytest.approx([8, 8 / 3, 8 / 3, 8 / 3])
    assert unchanged_rows(mesh, split).tolist() == [0]
    assert split.triangle_ids.tolist() == [0, 1, 2, 3]
    assert (split.next_vertex_id, split.next_triangle_id) == (5, 4)
    assert split.triangles[1].tolist() == [1, 2, 4]  # of equal ones that with the base edge 1 -> 2


@pytest.mark.parametrize("seed", range(4))
def test_split_any_set_of_triangles_at_any_inner_points(seed: int) -> None:
    """A random half of the triangles splits at random points inside."""
    mesh, rng = random_mesh(seed), np.random.default_rng(seed)
    chosen = np.flatnonzero(rng.random(mesh.triangle_count) < 0.5)
    weights = rng.dirichlet([2, 2, 2], len(chosen))
    points = np.einsum("nc,ncx->nx", weights, mesh.vertices[mesh.triangles[chosen]])
    split = split_triangles(mesh, chosen, points)
    assert_valid(split)
    assert split.triangle_count == mesh.triangle_count + 2 * len(chosen)
    assert np.array_equal(split.vertices[mesh.vertex_count :], points)
    assert_largest_child_goes_on(mesh, split, chosen)
    assert len(unchanged_rows(mesh, split)) == mesh.triangle_count - len(chosen)


@pytest.mark.parametrize("point", [(9.0, 9.0), (4.0, 0.0), (2.0, 2.0)])
def test_split_triangle_refuses_points_that_are_not_inside(point: tuple[float, float]) -> None:
    """Points outside, on a corner or on an edge are refused."""
    with pytest.raises(ValueError, match="inside"):
        split_triangles(two_triangles(), [0], [point])


def test_split_triangle_refuses_to_split_one_twice() -> None:
    """The same triangle twice in one set is refused."""
    with pytest.raises(ValueError, match="twice"):
        split_triangles(two_triangles(), [0, 0])


def test_empty_sets_change_nothing() -> None:
    """Every edit of nothing gives an equal mesh."""
    mesh, nothing = random_mesh(0), np.array([], dtype=np.int64)
    edits = (split_triangles, split_edges, flip_edges, collapse_edges, turn_base_edge)
    for edit in edits:
        same = edit(mesh, nothing)
        assert np.array_equal(same.triangles, mesh.triangles)
        assert np.array_equal(same.vertices, mesh.vertices)
        assert same.next_triangle_id == mesh.next_triangle_id


@pytest.mark.parametrize("seed", range(4))
def test_split_any_independent_edges(seed: int) -> None:
    """Inner and border edges split at their midpoints, two or one triangle more for each."""
    mesh = random_mesh(seed)
    edges = np.random.default_rng(seed).permutation(mesh.edge_half_edges)
    edges = edges[independent_flips(mesh, edges)]
    touched = edge_triangles(mesh, edges)
    touched = np.unique(touched[touched >= 0])
    inner = mesh.twins[edges] >= 0
    assert inner.any()
    assert not inner.all()
    split = split_edges(mesh, edges)
    assert_valid(split)
    assert split.triangle_count == mesh.triangle_count + len(edges) + inner.sum()
    assert split.vertex_count == mesh.vertex_count + len(edges)
    kept = np.setdiff1d(np.arange(mesh.triangle_count), touched)
    assert unchanged_rows(mesh, split).tolist() == kept.tolist()
    uneven = split_edges(mesh, edges, _at_a_third(mesh, edges))
    assert_largest_child_goes_on(mesh, uneven, touched)


def _at_a_third(mesh: Mesh, edges: np.ndarray) -> np.ndarray:
    """Points on edges, nearer to their begins."""
    begins, ends = edge_ends(mesh, edges)
    return (2 * mesh.vertices[begins] + mesh.vertices[ends]) / 3


def test_split_edges_refuses_neighbours_and_points_off_the_border() -> None:
    """Two edges of one triangle, and a border point inside the domain, are refused."""
    mesh = two_triangles()
    with pytest.raises(ValueError, match="do not touch"):
        split_edges(mesh, [0, 1])
    with pytest.raises(ValueError, match="on the border"):
        split_edges(mesh, [0], [(2.0, 0.5)])
    with pytest.raises(ValueError, match="inside"):
        split_edges(mesh, [0], [(5.0, 0.0)])
    assert_valid(split_edges(mesh, [0], [(1.0, 0.0)]))


# Flips


def test_flip_exchanges_the_diagonal_of_a_square() -> None:
    """The square's other diagonal appears, both triangles keep their places and ids."""
    mesh = two_triangles()
    (half_edge,) = np.flatnonzero(mesh.twins > np.arange(6))
    flipped = flip_edges(mesh, [half_edge])
    assert_valid(flipped)
    assert triangle_set(flipped.triangles) == {(0, 1, 2), (0, 2, 3)}
    assert flipped.triangle_ids.tolist() == [0, 1]
    (half_edge,) = np.flatnonzero(flipped.twins > np.arange(6))
    again = flip_edges(flipped, [half_edge])
    assert triangle_set(again.triangles) == triangle_set(mesh.triangles)


@pytest.mark.parametrize("seed", range(4))
def test_flipped_triangles_go_on_where_they_were(seed: int) -> None:
    """Ids are exchanged so that the common area is largest; two corners keep their places."""
    mesh = random_mesh(seed)
    edges = np.random.default_rng(seed).permutation(mesh.edge_half_edges)
    edges = edges[flippable(mesh, edges)]
    edges = edges[independent_flips(mesh, edges)]
    flipped = flip_edges(mesh, edges)
    for pair in edge_triangles(mesh, edges):
        before, after = mesh.triangles[pair], flipped.triangles[pair]
        assert ((before == after).sum(axis=1) == 2).all()
        own, other = (
            sum(
                common_area(mesh.vertices[x], mesh.vertices[y])
                for x, y in zip(before, new, strict=True)
            )
            for new in (after, after[::-1])
        )
        assert own >= other - 1e-9


def common_area(one: np.ndarray, other: np.ndarray) -> float:
    """Area that two triangles share, by OpenCV."""
    area, _ = cv2.intersectConvexConvex(one.astype(np.float32), other.astype(np.float32))
    return area


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_random_flips_keep_the_mesh_and_its_tables(seed: int) -> None:
    """After rounds of independent flips the mesh is valid and its twins equal fresh ones."""
    mesh = random_mesh(seed % 7)
    flipped = scrambled(mesh, seed)
    assert_valid(flipped)
    assert np.array_equal(flipped.twins, twins_of(flipped.triangles, flipped.vertex_count))
    assert np.array_equal(flipped.triangle_ids, mesh.triangle_ids)


def test_flip_refuses_the_border_and_what_is_not_convex() -> None:
    """A border edge, and the edges around a vertex of three triangles, cannot be flipped."""
    mesh = split_triangles(two_triangles(), [0])
    spokes = np.flatnonzero((mesh.triangles.ravel() == 4) & (mesh.twins >= 0))
    assert not flippable(mesh, spokes).any()
    assert not flippable(mesh, np.flatnonzero(mesh.twins < 0)).any()
    with pytest.raises(ValueError, match="flippable"):
        flip_edges(mesh, spokes[:1])


def test_flip_refuses_two_flips_in_one_triangle() -> None:
    """Flips that share a triangle are refused."""
    mesh = random_mesh(0)
    both = [e for e in range(3 * mesh.triangle_count) if flippable(mesh, [e])[0]]
    same = next(e for e in both if e + 1 in both and e // 3 == (e + 1) // 3)
    with pytest.raises(ValueError, match="independent_flips"):
        flip_edges(mesh, [same, same + 1])


# Collapses


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_legal_independent_collapses_keep_the_mesh(seed: int) -> None:
    """All legal collapses of a random order, in both directions, leave a valid mesh."""
    mesh, rng = scrambled(random_mesh(seed % 5), seed, 2), np.random.default_rng(seed)
    edges = rng.permutation(mesh.edge_half_edges)
    reverse = rng.random(len(edges)) < 0.5
    legal = collapsible(mesh, edges, 0.1, reverse)
    edges, reverse = edges[legal], reverse[legal]
    chosen = independent_collapses(mesh, edges, reverse)
    edges, reverse = edges[chosen], reverse[chosen]
    collapsed = collapse_edges(mesh, edges, reverse)
    assert_valid(collapsed)
    assert collapsed.vertex_count == mesh.vertex_count - len(edges)
    inner = mesh.twins[edges] >= 0
    assert collapsed.triangle_count == mesh.triangle_count - len(edges) - inner.sum()
    assert np.isin(collapsed.triangle_ids, mesh.triangle_ids).all()
    assert collapsed.heights.min() >= min(0.1, mesh.heights.min())
    gone, _ = edge_ends(mesh, edges, reverse)
    assert not np.isin(mesh.vertex_ids[gone], collapsed.vertex_ids).any()


def test_collapse_undoes_a_split() -> None:
    """Collapsing the vertex of a split gives the triangle back."""
    mesh = random_mesh(3)
    split = split_triangles(mesh, [17])
    spokes = np.flatnonzero(split.triangles.ravel() == mesh.vertex_count)
    assert collapsible(split, spokes).all()
    for spoke in spokes:
        back = collapse_edges(split, [spoke])
        assert_valid(back)
        assert triangle_set(back.triangles) == triangle_set(mesh.triangles)


def test_corners_and_border_vertices_obey_the_border() -> None:
    """Corners never vanish; a border vertex only moves along its border."""
    mesh = random_mesh(2)
    half_edges = np.arange(3 * mesh.triangle_count)
    origins, destinations = edge_ends(mesh, half_edges)
    legal = collapsible(mesh, half_edges)
    corner = mesh.on_left_right & mesh.on_top_bottom
    border = mesh.on_left_right | mesh.on_top_bottom
    assert not legal[corner[origins]].any()
    sliding = border[origins] & legal
    assert sliding.any()
    assert border[destinations[sliding]].all()
    assert (mesh.twins[sliding] < 0).all()
    assert legal[~border[origins] & border[destinations]].any()


def test_a_border_vertex_collapses_either_way_along_its_border() -> None:
    """`reverse` names the direction that a border edge has no half-edge for."""
    mesh = split_edges(two_triangles(), [0])
    (into_corner,) = [e for e in np.flatnonzero(mesh.twins < 0) if mesh.triangles.ravel()[e] == 4]
    (from_corner,) = [
        e for e in np.flatnonzero(mesh.twins < 0) if edge_ends(mesh, [e])[1].tolist() == [4]
    ]
    assert collapsible(mesh, [into_corner, from_corner]).tolist() == [True, False]
    both = collapsible(mesh, [into_corner, from_corner], reverse=np.array([True, True]))
    assert both.tolist() == [False, True]
    for collapsed in (
        collapse_edges(mesh, [into_corner]),
        collapse_edges(mesh, [from_corner], np.array([True])),
    ):
        assert_valid(collapsed)
        assert collapsed.triangle_count == 2


def test_collapse_refuses_folds_thin_results_and_neighbours() -> None:
    """What `collapsible` denies is refused, a height limit denies more, stars must not touch."""
    mesh = random_mesh(4)
    half_edges = np.arange(3 * mesh.triangle_count)
    legal = collapsible(mesh, half_edges)
    with pytest.raises(ValueError, match="collapsible"):
        collapse_edges(mesh, half_edges[~legal][:1])
    strict = collapsible(mesh, half_edges, min_height=2.0)
    assert (strict <= legal).all()
    assert strict.sum() < legal.sum()
    with pytest.raises(ValueError, match="independent_collapses"):
        collapse_edges(mesh, half_edges[legal])


def test_collapsible_agrees_with_trying() -> None:
    """A collapse is legal exactly if moving the vertex leaves no triangle turned over."""
    mesh = random_mesh(5, inner=25)
    half_edges = np.arange(3 * mesh.triangle_count)
    border = mesh.on_left_right | mesh.on_top_bottom
    origins, destinations = edge_ends(mesh, half_edges)
    for e in np.flatnonzero(~border[origins]):
        vertices = mesh.vertices.copy()
        vertices[origins[e]] = vertices[destinations[e]]
        areas = mesh.moved(vertices).areas
        expected = (areas > 0).sum() == mesh.triangle_count - 2
        assert collapsible(mesh, [e])[0] == expected


# Independent sets and base edges


def _in_order(claims: list[set[int]]) -> list[bool]:
    taken: set[int] = set()
    granted = []
    for claim in claims:
        granted.append(not claim & taken)
        if granted[-1]:
            taken |= claim
    return granted


@pytest.mark.parametrize("seed", range(4))
def test_independent_sets_are_those_of_a_greedy_loop(seed: int) -> None:
    """The vectorised choices equal a loop in order of priority, hence are maximal."""
    mesh = random_mesh(seed)
    edges = np.random.default_rng(seed).permutation(mesh.edge_half_edges)
    pairs = [set(pair) - {-1} for pair in edge_triangles(mesh, edges).tolist()]
    assert independent_flips(mesh, edges).tolist() == _in_order(pairs)
    edits, corners = stars(mesh, edge_ends(mesh, edges)[0])
    claims = [set((corners[edits == edit] // 3).tolist()) for edit in range(len(edges))]
    assert independent_collapses(mesh, edges).tolist() == _in_order(claims)


def test_turning_the_base_edge_three_times_gives_the_row_back() -> None:
    """Each turn moves the base edge on by one, keeps ids, and leaves other rows alone."""
    mesh = random_mesh(1)
    turned = turn_base_edge(mesh, [4, 9])
    assert_valid(turned)
    assert turned.triangles[4].tolist() == mesh.triangles[4, [1, 2, 0]].tolist()
    assert np.array_equal(turned.triangle_ids, mesh.triangle_ids)
    others = np.setdiff1d(np.arange(mesh.triangle_count), [4, 9])
    assert np.array_equal(turned.triangles[others], mesh.triangles[others])
    again = turn_base_edge(turn_base_edge(turned, [4, 9]), [4, 9])
    assert np.array_equal(again.triangles, mesh.triangles)


def test_press_refuses_what_would_fold_or_is_not_on_the_border() -> None:
    """Inner edges, apexes on the border, apexes beyond the edge's ends, and neighbours."""
    points = np.array([[0, 0], [20, 0], [20, 20], [0, 20], [6, 4], [14, 4]])
    rows = [[0, 1, 4], [1, 5, 4], [1, 2, 5], [2, 3, 5], [3, 4, 5], [3, 0, 4]]
    mesh = mesh_of(points, rows, 20, 20)
    border = np.flatnonzero(mesh.twins < 0)
    inner = np.flatnonzero(mesh.twins >= 0)
    assert not pressable(mesh, inner).any()
    possible = border[pressable(mesh, border)]
    assert len(possible)
    for edge in possible:
        assert_valid(press_onto_border(mesh, [edge]))
    for edge in np.setdiff1d(np.arange(3 * mesh.triangle_count), possible):
        with pytest.raises(ValueError, match="pressed"):
            press_onto_border(mesh, [edge])
    with pytest.raises(ValueError, match="share"):
        press_onto_border(mesh, possible[[0, 0]])


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_pressing_keeps_meshes_valid(seed: int) -> None:
    """Any one that is allowed, on random meshes with many vertices near the border."""
    mesh = random_mesh(seed, inner=60)
    edges = np.arange(3 * mesh.triangle_count)
    for edge in edges[pressable(mesh, edges)]:
        pressed = press_onto_border(mesh, [edge])
        assert_valid(pressed)
        assert pressed.triangle_count == mesh.triangle_count - 1
