"""The thirteen triangles whose errors make a gradient: Eq. 11, in exact arithmetic."""

from collections.abc import Iterator

import numpy as np

from tests.oracles.coverage import Corner, rounded

STEPS = ((1, 0), (-1, 0), (0, 1), (0, -1))
"""Directions +x, -x, +y, -y [px]."""


def variants(corners: np.ndarray) -> Iterator[list[Corner]]:
    """Give the triangle itself, then corner by corner its displaced versions.

    Args:
        corners: Positions [px], [3, 2].
    """
    still = [rounded(x, y) for x, y in corners.tolist()]
    yield still
    for corner in range(3):
        for dx, dy in STEPS:
            moved = list(still)
            moved[corner] = (still[corner][0] + dx, still[corner][1] + dy)
            yield moved
