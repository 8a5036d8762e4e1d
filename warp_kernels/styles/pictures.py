"""Pictures for triangles that need no file; the lower edge of a picture is the base edge."""

from collections.abc import Callable
from functools import cache

import numpy as np

SIDE = 512
"""Rows and columns of a picture."""
FINER = 2
"""Samples per row and column that are averaged: no steps along slanted lines."""
WHIRL = 0.16
"""How far along the sides of a nested triangle the next one has its corners."""
NESTED = 12
"""Triangles within each other; the innermost one is a thousandth of the area."""


def weights() -> np.ndarray:
    """Barycentric coordinates of the samples of a picture, [3, rows, columns]; negative outside.

    Corner 0 is the lower right of the picture, corner 1 the lower left, corner 2 the middle of
    the upper border: so no picture is mirrored.
    """
    count = SIDE * FINER
    up = (1.0 - (np.arange(count) + 0.5) / count)[:, None]
    left = 1.0 - (np.arange(count) + 0.5)[None, :] / count - up / 2
    return np.stack([1.0 - left - up, left, np.broadcast_to(up, left.shape)])


def averaged(samples: np.ndarray) -> np.ndarray:
    """A picture from its samples, [rows, columns]."""
    return samples.reshape(SIDE, FINER, SIDE, FINER).mean(axis=(1, 3))


@cache
def cushion() -> np.ndarray:
    """Raised in the middle, dark along the seams: brightness, 0 to 1, [rows, columns]."""
    height = 27.0 * np.prod(np.maximum(weights(), 0.0), axis=0)
    return averaged(0.24 + 0.36 * height**0.6)


@cache
def nested_triangles() -> np.ndarray:
    """Triangles within triangles, each turned a little: brightness, 0 to 1, [rows, columns]."""
    place = weights()
    depth = np.zeros(place.shape[1:])
    turn = np.linalg.inv((1.0 - WHIRL) * np.eye(3) + WHIRL * np.roll(np.eye(3), 1, axis=0))
    for _ in range(NESTED):
        place = np.tensordot(turn, place, axes=1)
        depth += (place >= 0).all(axis=0)
    share = depth / NESTED
    stripes = np.where(depth % 2 == 0, -0.05, 0.05)
    return averaged(0.46 + 0.14 * share + stripes)


PICTURES: dict[str, Callable[[], np.ndarray]] = {
    "cushion": cushion,
    "triangle": nested_triangles,
}
"""By the names that users give."""
