"""Triangles that are drawn so large that their corners are out of reach, in pieces that are not."""

import numpy as np

MOST_HALVED = 6
"""How often sides are halved at most; what is larger still is left out."""


def within_reach(
    corners: np.ndarray, picture: tuple[int, int], reach: float
) -> tuple[np.ndarray, np.ndarray]:
    """Cut up what is too large, and leave out what the picture does not show.

    Args:
        corners: Where triangles are drawn [px of the picture], [N, 3, 2].
        picture: Width and height of the picture [px].
        reach: How far outside of it corners may be [px].

    Returns:
        For every piece the number of its triangle, ascending, [P], and its corners, [P, 3, 2]. A
        triangle within reach is one piece.
    """
    numbers = np.arange(len(corners))
    found: list[tuple[np.ndarray, np.ndarray]] = []
    for _ in range(MOST_HALVED + 1):
        low, high = corners.min(axis=1), corners.max(axis=1)
        meets = ((high > 0) & (low < picture)).all(axis=1)
        fits = ((low > -reach) & (high < np.array(picture) + reach)).all(axis=1)
        found.append((numbers[meets & fits], corners[meets & fits]))
        numbers, corners = numbers[meets & ~fits], corners[meets & ~fits]
        if not len(numbers):
            break
        numbers, corners = np.tile(numbers, 4), np.concatenate(_quarters(corners))
    numbers, corners = (np.concatenate(parts) for parts in zip(*found, strict=True))
    order = np.argsort(numbers, kind="stable")
    return numbers[order], corners[order]


def _quarters(corners: np.ndarray) -> list[np.ndarray]:
    """Four triangles for each, between its corners and the middles of its sides."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    cut = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
    return [np.stack(three, axis=1) for three in cut]
