"""Triangles that are a little larger, so that neighbours overlap."""

import numpy as np

MITRE = 2.0
"""Most that a corner moves, in widths of the overlap: needles would grow out of all bounds."""


def grown(corners: np.ndarray, width: float) -> np.ndarray:
    """Triangles whose sides have moved outwards.

    Args:
        corners: Positions, clockwise on the screen [px], [N, 3, 2].
        width: How far [px].

    Returns:
        Positions [px], [N, 3, 2].
    """
    sides = np.roll(corners, -1, axis=1) - corners
    lengths = np.maximum(np.linalg.norm(sides, axis=2, keepdims=True), 1e-9)
    outwards = np.stack([sides[..., 1], -sides[..., 0]], axis=2) / lengths
    before = np.roll(outwards, 1, axis=1)
    # the corner of two lines that moved: their normals' sum, over 1 + the cosine between them
    cosines = 1.0 + (outwards * before).sum(axis=2, keepdims=True)
    away = (outwards + before) / np.maximum(cosines, 1e-9)
    far = np.maximum(np.linalg.norm(away, axis=2, keepdims=True), 1e-9)
    return np.asarray(corners + width * away * np.minimum(1.0, MITRE / far))
