"""Take vertices away, each into its nearest neighbour that it can go into."""

import numpy as np

from stages.edits import collapse_edges, collapsible, independent_collapses
from stages.edits.neighbourhood import edge_ends, stars
from stages.hand.worked import Worked
from stages.mesh import previous_corner


def without_vertices(worked: Worked, vertices: np.ndarray) -> tuple[Worked, int]:
    """Collapse vertices, in rounds of those that do not touch each other.

    The triangles that change stay bare: nothing puts vertices back there. What cannot go stays.

    Args:
        worked: The mesh.
        vertices: Their numbers, shape [N], the most wanted first.

    Returns:
        What becomes of it, and how many vertices went.
    """
    wanted = worked.mesh.vertex_ids[vertices]
    gone = 0
    while True:
        mesh = worked.mesh
        places = np.searchsorted(mesh.vertex_ids, wanted)
        half_edges, reverse = _nearest_legal(worked, places)
        chosen = independent_collapses(mesh, half_edges, reverse)
        half_edges, reverse = half_edges[chosen], reverse[chosen]
        if not len(half_edges):
            return worked, gone
        origins, _ = edge_ends(mesh, half_edges, reverse)
        _, corners = stars(mesh, origins)
        bare = mesh.triangle_ids[np.unique(corners // 3)]
        ids = mesh.vertex_ids[origins]
        locks = worked.locks.without(vertices=ids).adding(bare=bare)
        worked = worked.became(collapse_edges(mesh, half_edges, reverse), locks)
        wanted = wanted[~np.isin(wanted, ids)]
        gone += len(ids)


def _nearest_legal(worked: Worked, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each of some vertices that can vanish the shortest edge that it can do so along.

    Args:
        worked: The mesh.
        vertices: Their numbers, shape [N].

    Returns:
        Half-edges, in the order of the vertices, and where the destination is what vanishes.
    """
    mesh = worked.mesh
    places, out = stars(mesh, vertices)
    into = previous_corner(out)
    on_border = mesh.twins[into] < 0
    half_edges = np.concatenate([out, into[on_border]])
    places = np.concatenate([places, places[on_border]])
    reverse = np.repeat([False, True], [len(out), int(on_border.sum())])
    legal = collapsible(mesh, half_edges, reverse=reverse)
    half_edges, places, reverse = half_edges[legal], places[legal], reverse[legal]
    origins, destinations = edge_ends(mesh, half_edges, reverse)
    lengths = ((mesh.vertices[origins] - mesh.vertices[destinations]) ** 2).sum(axis=1)
    order = np.lexsort([lengths, places])
    first = np.unique(places[order], return_index=True)[1]
    best = order[first]
    return half_edges[best], reverse[best]
