"""In which order a pen draws, so that it travels little with nothing to draw."""

import numpy as np

BITS = 10
"""Of each coordinate along the curve."""


def short_way(places: np.ndarray) -> np.ndarray:
    """An order in which places that follow each other are near to each other.

    Args:
        places: Positions, [N, 2].

    Returns:
        Numbers of the places, [N].

    Source: Hilbert, Ueber die stetige Abbildung einer Linie auf ein Flaechenstueck (1891).
    """
    low, high = places.min(axis=0), places.max(axis=0)
    side = max(float((high - low).max()), 1e-9)
    x, y = np.floor((places - low) / side * ((1 << BITS) - 1)).astype(np.int64).T
    along = np.zeros(len(places), np.int64)
    for bit in reversed(range(BITS)):
        size = 1 << bit
        right, down = (x & size) > 0, (y & size) > 0
        along += size * size * ((3 * right) ^ down)
        # each quarter is entered where the one before is left
        is_flipped = ~down & right
        x, y = np.where(is_flipped, size - 1 - x, x), np.where(is_flipped, size - 1 - y, y)
        x, y = np.where(down, x, y), np.where(down, y, x)
    return np.argsort(along, kind="stable")
