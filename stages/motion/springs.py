"""What holds the vertices of a followed mesh to where the motion took them."""

import numpy as np

from stages.mesh import Mesh
from stages.motion.advect import Carried

REST_FIRMNESS, FIRMEST = 1.5, 4.0
"""Where weights lead triangles elsewhere the spring grows with this power of the mean weight beside
the median one, up to so many times."""
LOCK = 1e12
"""Strength of the spring of what a person holds fast [code value^2]: whatever pulls at it moves it
by less than the dead band."""


def springs_of(
    mesh: Mesh, seed: Carried, strength: float, weights: np.ndarray | None, hold: float = 0.0
) -> np.ndarray:
    """Where the temporal term holds each vertex, how strongly and how fast; new ones are free.

    Args:
        mesh: What has become of the seed.
        seed: Where the motion took the vertices.
        strength: Of the spring where the motion is certain [code value^2].
        weights: The picture's: what pulls at a vertex grows with them, and so must its spring;
            [H, W] uint8, or None.
        hold: Of the spring wherever the motion leads, for a layout that is kept [code value^2].

    Returns:
        Places [px], strengths [code value^2] and what is told by `Carried.friction` [px], [V, 4].
    """
    springs = np.zeros((mesh.vertex_count, 4))
    springs[:, :2] = mesh.vertices
    old = np.searchsorted(seed.mesh.vertex_ids, mesh.vertex_ids)
    known = mesh.vertex_ids < seed.mesh.next_vertex_id
    springs[known, :2] = seed.mesh.vertices[old[known]]
    springs[known, 2] = strength * seed.trust[old[known]] + hold
    if seed.friction is not None:
        springs[known, 3] = seed.friction[old[known]]
    if weights is not None:
        springs[:, 2] *= _firmness(weights, springs[:, :2])
    if not seed.locks.is_empty:
        springs[np.isin(mesh.vertex_ids, seed.locks.vertices), 2] = LOCK
    return springs


def _firmness(weights: np.ndarray, points: np.ndarray) -> np.ndarray:
    """How much firmer springs are for the weights of a picture.

    Most of a picture has fewer triangles than without weights, which show more of every change:
    there vertices are held the more firmly the more of them went elsewhere. Where errors count
    more than in the mean they are held as ever: what pulls at a vertex grows with the weight around
    it and falls with the length of its edges, and such places should follow closely.

    Args:
        weights: [H, W] uint8.
        points: Positions [px], [N, 2].

    Returns:
        1 where all weights are alike, [N].
    """
    mean, usual = float(weights.mean()), float(np.median(weights))
    if mean <= usual:
        return np.ones(len(points))
    rest = min((mean / usual) ** REST_FIRMNESS, FIRMEST)
    size = np.array(weights.shape[::-1])
    columns, rows = np.clip(points.astype(np.int64), 0, size - 1).T
    heavy = np.clip((weights[rows, columns] - usual) / (mean - usual), 0.0, 1.0)
    firmer: np.ndarray = rest + heavy * (1.0 - rest)
    return firmer
