"""Take away what comes to lie behind something else."""

import numpy as np

from stages.edits import collapse_edges, collapsible
from stages.edits.collapse_edges import collapsed_heights
from stages.edits.independent import independent_collapses
from stages.edits.neighbourhood import edge_ends, stars
from stages.mesh import Mesh, previous_corner

MOST_ROUNDS = 30
"""Rounds of collapses; a band as wide as a fast step holds several layers of triangles."""
LEAST_RELIEF = 1e-9
"""A collapse must lessen what is missing by more than this, which is rounding [px]."""


def collapse_covered(
    mesh: Mesh, steps: np.ndarray, least_height: float, held: np.ndarray | None = None
) -> tuple[Mesh, np.ndarray]:
    """Collapse triangles that motion turns over: one thing has slid over another there.

    What the triangles around a vertex lack to their least height is taken together; edges
    collapse by which it becomes less, those first that help most. What cannot be helped stays.

    Args:
        mesh: A valid mesh.
        steps: Where its vertices go [px], shape [V, 2].
        least_height: Height that moved triangles shall have, unless they were lower [px].
        held: Ids of vertices that a person holds fast: they go only where no other helps; None
            for none.

    Returns:
        A valid mesh at the old places, and the steps of its vertices.
    """
    barred = held if held is not None and len(held) else None
    for _ in range(MOST_ROUNDS):
        moved = mesh.moved(mesh.vertices + steps)
        least = np.minimum(least_height, (1.0 - 1e-9) * mesh.heights)
        lacking = np.maximum(0.0, least - moved.heights)
        if not lacking.any():
            break
        half_edges, reverse = _edges_around(mesh, np.flatnonzero(lacking))
        origins, destinations = edge_ends(mesh, half_edges, reverse)
        places, corners = stars(mesh, origins)
        before = np.bincount(places, lacking[corners // 3], len(origins))
        edits, triangles, heights = collapsed_heights(moved, origins, destinations)
        after = np.maximum(0.0, least[triangles] - heights)
        relief = before - np.bincount(edits, after, len(origins))
        helps = relief > LEAST_RELIEF
        if barred is not None:
            helps &= ~np.isin(mesh.vertex_ids[origins], barred)
        useful = np.flatnonzero(helps)
        useful = useful[collapsible(mesh, half_edges[useful], reverse=reverse[useful])]
        useful = useful[np.argsort(-relief[useful], kind="stable")]
        useful = useful[independent_collapses(mesh, half_edges[useful], reverse[useful])]
        if not len(useful):
            if barred is None:
                break
            barred = None
            continue
        stays = np.ones(mesh.vertex_count, dtype=bool)
        stays[origins[useful]] = False
        mesh = collapse_edges(mesh, half_edges[useful], reverse[useful])
        steps = steps[stays]
    return mesh, steps


def _edges_around(mesh: Mesh, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All collapses of the corners of some triangles.

    Args:
        mesh: A valid mesh.
        triangles: Their numbers, shape [N].

    Returns:
        Half-edges [M], and where the destination moves into the origin [M] bool: only so can a
        vertex move along the border half-edge that leads to it.
    """
    _, out = stars(mesh, np.unique(mesh.triangles[triangles]))
    into = previous_corner(out)
    into = into[mesh.twins[into] < 0]
    reverse = np.repeat([False, True], [len(out), len(into)])
    return np.concatenate([out, into]), reverse
