"""Find the triangles in which points lie."""

import numpy as np
from scipy.spatial import cKDTree

from stages.mesh import Mesh, areas_of

MOST_STEPS = 500
"""A walk that has not arrived by then stays where it is: only a folded mesh leads in circles for
so long."""


def locate(mesh: Mesh, points: np.ndarray) -> np.ndarray:
    """Walk from the nearest centroid to each point, across one edge at a step.

    Args:
        mesh: A valid mesh.
        points: Positions in its domain [px], shape [N, 2].

    Returns:
        Triangle numbers, shape [N] int64.

    Source: Devillers et al., Walking in a Triangulation (2001), the visibility walk.
    """
    corners = mesh.vertices[mesh.triangles]
    found = cKDTree(corners.mean(axis=1)).query(points)[1].astype(np.int64)
    twins = mesh.twins.reshape(-1, 3)
    walking = np.arange(len(points))
    for _ in range(MOST_STEPS):
        sides = _sides(corners[found[walking]], points[walking])
        across = twins[found[walking], sides.argmin(axis=1)]
        onward = (sides.min(axis=1, initial=0.0) < 0) & (across >= 0)
        walking = walking[onward]
        if not len(walking):
            break
        found[walking] = across[onward] // 3
    return found


def _sides(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Signed areas between points and the edges of triangles [px^2], negative outside; [N, 3]."""
    ends = np.roll(corners, -1, axis=1)
    apexes = np.broadcast_to(points[:, None], corners.shape)
    return areas_of(np.stack([corners, ends, apexes], axis=2).reshape(-1, 3, 2)).reshape(-1, 3)
