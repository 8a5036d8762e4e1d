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
    low, high = _bounds(first)
    others_low, others_high = _bounds(second)
    # Cells about as large as two triangles: a box lies in a few, also where some boxes are wide.
    across = max(1, int(np.sqrt(len(second) / 2)))
    begin = others_low.min(axis=1)[:, None]
    size = np.maximum(others_high.max(axis=1)[:, None] - begin, 1e-9) / across

    def cells_of(bounds: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """The cells of some boxes."""
        low, high = (np.clip((bound - begin) // size, 0, across - 1) for bound in bounds)
        return _cells(low.astype(np.int64), high.astype(np.int64), across)

    ones, cells = cells_of((low, high))
    others, other_cells = cells_of((others_low, others_high))
    order = np.argsort(other_cells, kind="stable")
    begins, ends = (np.searchsorted(other_cells[order], cells, side) for side in ("left", "right"))
    places, within = _ragged(ends - begins)
    ones, others = ones[places], others[order[begins[places] + within]]
    meet = (others_low[:, others] < high[:, ones]) & (low[:, ones] < others_high[:, others])
    met = meet[0] & meet[1]
    pairs = np.unique(ones[met] * len(second) + others[met])
    return pairs // len(second), pairs % len(second)


def _bounds(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Upper left and lower right corners of bounding boxes [px], each [2, N]."""
    columns = _columns(triangles)
    return columns.min(axis=0), columns.max(axis=0)


def _cells(low: np.ndarray, high: np.ndarray, across: int) -> tuple[np.ndarray, np.ndarray]:
    """All cells that each box lies in: numbers of boxes [M] and of cells [M].

    Args:
        low: First column and row of each box, [2, N].
        high: Last column and row, [2, N].
        across: Cells in a row.
    """
    columns, rows = high - low + 1
    boxes, within = _ragged(columns * rows)
    row, column = np.divmod(within, columns[boxes])
    return boxes, (low[1, boxes] + row) * across + low[0, boxes] + column


def _ragged(counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For `counts[i]` entries of each i: the i of every entry, and its number among these."""
    owners = np.repeat(np.arange(len(counts)), counts)
    return owners, np.arange(len(owners)) - np.repeat(np.cumsum(counts) - counts, counts)
