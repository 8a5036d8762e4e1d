"""Choose edits that do not touch each other, best first."""

import numpy as np

from stages.edits.neighbourhood import edge_ends, edge_triangles, stars
from stages.mesh import Mesh


def independent_flips(mesh: Mesh, half_edges: np.ndarray) -> np.ndarray:
    """Choose flips (or edge splits) of which no two share a triangle.

    Args:
        mesh: The mesh to be edited.
        half_edges: Half-edge numbers, shape [N], the most wanted first.

    Returns:
        The choice that a loop in this order would make, shape [N] bool.
    """
    beside = edge_triangles(mesh, half_edges)
    edits, sides = np.nonzero(beside >= 0)
    return first_come(edits, beside[edits, sides], len(half_edges), mesh.triangle_count)


def independent_collapses(
    mesh: Mesh, half_edges: np.ndarray, reverse: np.ndarray | None = None
) -> np.ndarray:
    """Choose collapses whose origins' stars of triangles do not overlap.

    Args:
        mesh: The mesh to be edited.
        half_edges: Half-edge numbers, shape [N], the most wanted first.
        reverse: Where true the destination moves into the origin, shape [N] bool.

    Returns:
        The choice that a loop in this order would make, shape [N] bool.
    """
    origins, _ = edge_ends(mesh, half_edges, reverse)
    edits, corners = stars(mesh, origins)
    return first_come(edits, corners // 3, len(half_edges), mesh.triangle_count)


def first_come(
    edits: np.ndarray, claims: np.ndarray, edit_count: int, triangle_count: int
) -> np.ndarray:
    """Serve edits in their order, skipping each that claims what an earlier one was given.

    Each round grants every edit that comes first at all its claims and drops the edits that
    clash with it. The rounds are few unless the order runs along chains of neighbours.

    Args:
        edits: The edit of each claim, shape [M], ascending.
        claims: The triangle of each claim, shape [M].
        edit_count: Number of edits N.
        triangle_count: Number of triangles.

    Returns:
        The edits granted, shape [N] bool.
    """
    granted = np.zeros(edit_count, dtype=bool)
    first = np.empty(triangle_count, dtype=edits.dtype)
    while len(edits):
        first[claims[::-1]] = edits[::-1]  # of equal places the last write stays
        wins = np.zeros(edit_count, dtype=bool)
        wins[edits] = True
        wins[edits[first[claims] != edits]] = False
        granted |= wins
        settled = np.zeros(edit_count, dtype=bool)
        settled[edits[wins[first[claims]]]] = True
        edits, claims = edits[~settled[edits]], claims[~settled[edits]]
    return granted
