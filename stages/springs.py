"""What holds the vertices of a followed mesh to where the motion took them."""

import numpy as np

from stages.advect import Carried
from stages.mesh import Mesh


def springs_of(
    mesh: Mesh, seed: Carried, strength: float, weights: np.ndarray | None
) -> np.ndarray:
    """Where the temporal term holds each vertex, and how strongly; new ones are free.

    Args:
        mesh: What has become of the seed.
        seed: Where the motion took the vertices.
        strength: Of the spring where the motion is certain [code value^2].
        weights: The picture's: what pulls at a vertex grows with them, and so must its spring;
            [H, W] uint8, or None.

    Returns:
        Places [px] and strengths [code value^2], [V, 3].
    """
    springs = np.zeros((mesh.vertex_count, 3))
    springs[:, :2] = mesh.vertices
    old = np.searchsorted(seed.mesh.vertex_ids, mesh.vertex_ids)
    known = mesh.vertex_ids < seed.mesh.next_vertex_id
    springs[known, :2] = seed.mesh.vertices[old[known]]
    springs[known, 2] = strength * seed.trust[old[known]]
    if weights is not None:
        springs[:, 2] *= _weights_at(weights, springs[:, :2]) / weights.mean()
    return springs


def _weights_at(weights: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Weights of the pixels in which points [N, 2] lie, [N] float64."""
    size = np.array(weights.shape[::-1])
    columns, rows = np.clip(points.astype(np.int64), 0, size - 1).T
    return weights[rows, columns].astype(np.float64)
