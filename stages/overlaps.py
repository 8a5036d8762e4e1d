"""Which triangles of two sets overlap."""

import numpy as np

TOUCHING = 1e-6
"""Triangles that overlap by less than this touch [px]."""


def overlaps(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """List for each of some triangles those of others that it overlaps.

    Args:
        first: Corners [px], shape [A, 3, 2]; of any orientation, also without area.
        second: Corners [px], shape [B, 3, 2].

    Returns:
        Begin and end in the list for each of the first, [A, 2] int64, and the list: numbers of
        the second, ascending for each, [L] int64.
    """
    ones, others = _boxes_that_meet(first, second)
    pairs = [_columns(first)[:, :, ones], _columns(second)[:, :, others]]
    apart = np.zeros(len(ones), dtype=bool)
    for triangles in pairs:
        for corner in range(3):
            x, y = triangles[(corner + 1) % 3] - triangles[corner]
            length = np.maximum(np.sqrt(x * x + y * y), 1e-300)
            along = [(each[:, 1] * x - each[:, 0] * y) / length for each in pairs]
            begins = np.maximum(along[0].min(axis=0), along[1].min(axis=0))
            ends = np.minimum(along[0].max(axis=0), along[1].max(axis=0))
            apart |= ends - begins < TOUCHING
    ones, others = ones[~apart], others[~apart]
    ends = np.cumsum(np.bincount(ones, minlength=len(first)))
    return np.stack([np.concatenate([[0], ends[:-1]]), ends], axis=1), others


def _columns(triangles: np.ndarray) -> np.ndarray:
    """Corners [N, 3, 2] as [3, 2, N]: long rows are worked on faster than short ones."""
    return np.ascontiguousarray(triangles.transpose(1, 2, 0))


def _boxes_that_meet(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of triangles whose bounding boxes overlap, ascending."""
    low, high = (bound(_columns(first), axis=0) for bound in (np.min, np.max))
    others_low, others_high = (bound(_columns(second), axis=0) for bound in (np.min, np.max))
    order = np.argsort(others_low[0], kind="stable")
    others_low, others_high = others_low[:, order], others_high[:, order]
    # Sorted by their left ends, those that can reach a box stand together.
    widest = (others_high[0] - others_low[0]).max()
    begins = np.searchsorted(others_low[0], low[0] - widest)
    counts = np.searchsorted(others_low[0], high[0]) - begins
    ones = np.repeat(np.arange(len(first)), counts)
    others = np.arange(len(ones)) - np.repeat(np.cumsum(counts) - counts, counts) + begins[ones]
    meet = (others_low[:, others] < high[:, ones]) & (low[:, ones] < others_high[:, others])
    meet = meet[0] & meet[1]
    ones, others = ones[meet], order[others[meet]]
    sorted_pairs = np.lexsort((others, ones))
    return ones[sorted_pairs], others[sorted_pairs]
