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
    apart = np.zeros(len(ones), dtype=bool)
    for triangles in (first[ones], second[others]):
        sides = triangles[:, [1, 2, 0]] - triangles
        normals = np.stack([-sides[:, :, 1], sides[:, :, 0]], axis=2)
        normals /= np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), 1e-300)
        spans = [np.einsum("nsk,nck->nsc", normals, each) for each in (first[ones], second[others])]
        begins = np.maximum(spans[0].min(axis=2), spans[1].min(axis=2))
        ends = np.minimum(spans[0].max(axis=2), spans[1].max(axis=2))
        apart |= (ends - begins < TOUCHING).any(axis=1)
    ones, others = ones[~apart], others[~apart]
    ends = np.cumsum(np.bincount(ones, minlength=len(first)))
    return np.stack([np.concatenate([[0], ends[:-1]]), ends], axis=1), others


def _boxes_that_meet(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of triangles whose bounding boxes overlap, ascending."""
    low, high = first.min(axis=1), first.max(axis=1)
    order = np.argsort(second[:, :, 0].min(axis=1), kind="stable")
    others_low, others_high = second[order].min(axis=1), second[order].max(axis=1)
    # Sorted by their left ends, those that can reach a box stand together.
    widest = (others_high - others_low)[:, 0].max()
    begins = np.searchsorted(others_low[:, 0], low[:, 0] - widest)
    counts = np.searchsorted(others_low[:, 0], high[:, 0]) - begins
    counts = np.maximum(counts, 0)
    ones = np.repeat(np.arange(len(first)), counts)
    others = np.arange(len(ones)) - np.repeat(np.cumsum(counts) - counts, counts) + begins[ones]
    meet = (others_low[others] < high[ones]) & (low[ones] < others_high[others])
    ones, others = ones[meet.all(axis=1)], order[others[meet.all(axis=1)]]
    sorted_pairs = np.lexsort((others, ones))
    return ones[sorted_pairs], others[sorted_pairs]
