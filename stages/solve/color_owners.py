"""Triangles that lie between the pixels' centres: whose colour they take."""

import numpy as np

from stages.mesh import Mesh


def color_owners(mesh: Mesh, counts: np.ndarray) -> np.ndarray:
    """For every triangle the one whose colour it shows.

    That is itself. A triangle that covers no pixel's centre has no colour of its own, and yet parts
    of pixels are drawn in it; it goes on as the neighbour across its longest side, or across the
    longest one that leads to a colour. As a needle it lies along that side: it looks like a part
    of the neighbour, and where the colour changes across the picture it goes on without a seam.

    Args:
        mesh: The triangles.
        counts: Pixels covered, or the sum of their weights, [T].

    Returns:
        Triangle numbers, [T].
    """
    owners = np.arange(mesh.triangle_count)
    blank = np.flatnonzero(counts == 0)
    while len(blank):
        twins = _twins_of(mesh, blank)
        corners = mesh.corners[blank]
        lengths = np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
        beside = owners[twins // 3]
        lengths[(twins < 0) | (counts[beside] == 0)] = -1.0
        best = (np.arange(len(blank)), lengths.argmax(axis=1))
        found = lengths[best] >= 0.0
        if not found.any():
            break  # not one triangle covers a pixel
        owners[blank[found]] = beside[best][found]
        blank = blank[~found]
    return owners


def _twins_of(mesh: Mesh, rows: np.ndarray) -> np.ndarray:
    """`mesh.twins` of a few triangles, without the table of all: it takes longer than to read a
    frame, [N, 3]."""
    there = mesh.triangles[rows].astype(np.int64)
    marks = np.zeros(mesh.vertex_count, dtype=np.int8)
    marks[there] = 1
    beside = marks.take(mesh.triangles)
    near = np.flatnonzero(beside[:, 0] + beside[:, 1] + beside[:, 2] >= 2)
    tails = mesh.triangles[near].astype(np.int64)
    edges = (tails * mesh.vertex_count + tails[:, [1, 2, 0]]).reshape(-1)
    order = np.argsort(edges)
    wanted = (there[:, [1, 2, 0]] * mesh.vertex_count + there).reshape(-1)
    places = order[np.minimum(np.searchsorted(edges, wanted, sorter=order), len(edges) - 1)]
    twins = np.where(edges[places] == wanted, 3 * near[places // 3] + places % 3, -1)
    return twins.reshape(-1, 3)
