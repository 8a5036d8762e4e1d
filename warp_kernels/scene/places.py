"""Positions as whole numbers, and numbers without order: the same bits on every machine."""

import numpy as np

from warp_kernels.scene.scene import FRACTION_BITS

FRACTION = float(1 << FRACTION_BITS)
"""Units of a place per px."""


def to_places(positions: np.ndarray) -> np.ndarray:
    """Positions [px] as places [2^-16 px], int64 of the same shape."""
    return np.rint(positions * FRACTION).astype(np.int64)


def hashes_of(ids: np.ndarray) -> np.ndarray:
    """A number without order for every id, [N] uint32.

    Args:
        ids: Persistent numbers, [N] int64.

    Source: Steele, Lea & Flood, Fast Splittable Pseudorandom Number Generators (2014): the
    finalizer of SplitMix64.
    """
    z = ids.astype(np.uint64) + np.uint64(0x9E3779B97F4A7C15)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return ((z ^ (z >> np.uint64(31))) >> np.uint64(32)).astype(np.uint32)


def centres(side: int, count: int) -> np.ndarray:
    """Places of the centres of equal parts of a side of the picture [2^-16 px], [count].

    Whole numbers throughout: parts that are a whole number of pixels apart are exactly so.

    Args:
        side: Length of the side [px].
        count: Number of parts.
    """
    halves = (2 * np.arange(count, dtype=np.int64) + 1) * side
    return (halves << (FRACTION_BITS - 1)) // count
