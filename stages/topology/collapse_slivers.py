"""Remove the triangles that have become too thin or too small."""

import numpy as np

from stages.edits import (
    collapse_edges,
    flip_edges,
    flippable,
    independent_collapses,
    independent_flips,
    press_onto_border,
    pressable,
)
from stages.edits.collapse_edges import collapsed_heights, keeps_border
from stages.edits.flip_edges import flipped_heights
from stages.edits.independent import first_come
from stages.edits.neighbourhood import edge_ends, edge_triangles, stars
from stages.mesh import Mesh, previous_corner

MOST_ROUNDS = 1000
"""More rounds than any mesh needs."""


def collapse_slivers(
    mesh: Mesh, min_height: float, min_area: float = 0.0, *, most_rounds: int = MOST_ROUNDS
) -> Mesh:
    """Collapse thin and small triangles on their shortest edges, thinnest first.

    Those that lie flat on the border are pressed onto it. Of an edge either end may move into the
    other: the direction is taken that leaves the highest triangles behind. A collapse may leave a
    triangle below `min_height` only if the star that it changes held a lower one that survives.
    Where no sliver can be collapsed, their longest edges are flipped if that raises the lower
    triangle of the pair; where that fails as well, the middle edges collapse. What nothing mends
    stays.

    Args:
        mesh: A valid mesh.
        min_height: Triangles of a smallest height below this go [px].
        min_area: Triangles of an area below this go [px^2].
        most_rounds: Rounds of edits; few are enough for a mesh that is soon looked at again.

    Returns:
        A valid mesh with as many triangles or fewer; the same object if nothing is to be done.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.4.
    Deviation: the paper collapses by area alone; a long needle of some area is a sliver here
        too, and the flip of the longest edge serves caps whose collapse would fold the mesh.
        The middle edge is for caps along the border, which have no partner for a flip.
    """
    # Every round removes triangles or raises the lowest heights, so the rounds end.
    for _ in range(most_rounds):
        slivers = np.flatnonzero((mesh.heights < min_height) | (mesh.areas < min_area))
        if not len(slivers):
            break
        slivers = slivers[np.argsort(mesh.heights[slivers], kind="stable")]
        mended = press_slivers(mesh, slivers, min_height)
        if mended is mesh:
            mended = _collapse(mesh, slivers, 0, min_height)
        if mended is mesh:
            mended = flip_longest(mesh, slivers)
        if mended is mesh:
            mended = _collapse(mesh, slivers, 1, min_height)
        if mended is mesh:
            break
        mesh = mended
    return mesh


def press_slivers(mesh: Mesh, slivers: np.ndarray, min_height: float) -> Mesh:
    """Press those onto the border whose longest edge lies there.

    Args:
        mesh: A valid mesh.
        slivers: Triangle numbers, shape [S], the most urgent first.
        min_height: Height that the triangles around keep [px].
    """
    longest = 3 * slivers + _lengths(mesh, slivers).argmax(axis=1)
    longest = longest[mesh.twins[longest] < 0]
    if not len(longest):
        return mesh
    longest = longest[pressable(mesh, longest, min_height)]
    places, corners = stars(mesh, mesh.triangles.reshape(-1)[previous_corner(longest)])
    chosen = first_come(places, corners // 3, len(longest), mesh.triangle_count)
    return press_onto_border(mesh, longest[chosen]) if chosen.any() else mesh


def _collapse(mesh: Mesh, slivers: np.ndarray, rank: int, min_height: float) -> Mesh:
    """Collapse one edge of each of some triangles, as far as it is legal.

    Args:
        mesh: A valid mesh.
        slivers: Triangle numbers, shape [S], the most urgent first.
        rank: Which edge: 0 the shortest, 1 the middle one.
        min_height: Height that changed triangles keep unless one was lower before [px].
    """
    ranked = 3 * slivers + _lengths(mesh, slivers).argsort(axis=1, kind="stable")[:, rank]
    half_edges = np.repeat(ranked, 2)
    reverse = np.tile([False, True], len(slivers))
    origins, destinations = edge_ends(mesh, half_edges, reverse)
    before, after = heights_around(mesh, origins, destinations)
    legal = keeps_border(mesh, half_edges, origins)
    legal &= (after > 0) & (after >= np.minimum(before, min_height))
    # Of the two directions of an edge the better one comes first.
    order = np.lexsort([-after, np.repeat(np.arange(len(slivers)), 2)])
    order = order[legal[order]]
    half_edges, reverse = half_edges[order], reverse[order]
    chosen = independent_collapses(mesh, half_edges, reverse)
    if not chosen.any():
        return mesh
    return collapse_edges(mesh, half_edges[chosen], reverse[chosen])


def heights_around(
    mesh: Mesh, origins: np.ndarray, destinations: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Lowest height among the triangles that survive each collapse, before and after [px, N]."""
    before, after = np.full((2, len(origins)), np.inf)
    edits, triangles, heights = collapsed_heights(mesh, origins, destinations)
    np.minimum.at(before, edits, mesh.heights[triangles])
    np.minimum.at(after, edits, heights)
    return before, after


def flip_longest(mesh: Mesh, slivers: np.ndarray) -> Mesh:
    """Flip the longest edges of some triangles where the lower triangle of the pair gains.

    Args:
        mesh: A valid mesh.
        slivers: Triangle numbers, shape [S], the most urgent first.
    """
    longest = raising_flips(mesh, slivers)
    chosen = independent_flips(mesh, longest)
    return flip_edges(mesh, longest[chosen]) if chosen.any() else mesh


def raising_flips(mesh: Mesh, slivers: np.ndarray) -> np.ndarray:
    """The longest edges of some triangles whose flip raises the lower triangle of the pair.

    Args:
        mesh: A valid mesh.
        slivers: Triangle numbers, shape [S], the most urgent first.

    Returns:
        Half-edge numbers, in this order, shape [N].
    """
    longest = 3 * slivers + _lengths(mesh, slivers).argmax(axis=1)
    longest = longest[flippable(mesh, longest)]
    lower = mesh.heights[edge_triangles(mesh, longest)].min(axis=1)
    return longest[flipped_heights(mesh, longest) > lower]


def _lengths(mesh: Mesh, triangles: np.ndarray) -> np.ndarray:
    """Lengths of the edges of some triangles [px], shape [N, 3]."""
    corners = mesh.vertices[mesh.triangles[triangles]]
    return np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
