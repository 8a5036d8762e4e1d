"""Points that keep a distance from each other, the most wanted first."""

import cv2
import numpy as np

CHUNK = 1024
"""Candidates that are looked at together."""


def apart(
    candidates: np.ndarray, radius: float | np.ndarray, size: tuple[int, int], most: int
) -> np.ndarray:
    """Serve pixels in their order, skipping each that lies within the radius of one served.

    Args:
        candidates: Pixels (column, row), [N, 2] int.
        radius: Distance to keep [px], one or [N].
        size: Width and height of the picture [px].
        most: Pixels to serve at most.

    Returns:
        The numbers of those served, [M].
    """
    blocked = np.zeros((size[1], size[0]), dtype=np.uint8)
    radii = np.broadcast_to(radius, len(candidates))
    served: list[int] = []
    for begin in range(0, len(candidates), CHUNK):
        # most candidates lie close to what was served before: they go all at once
        columns, rows = candidates[begin : begin + CHUNK].T
        for number in (begin + np.flatnonzero(blocked[rows, columns] == 0)).tolist():
            column, row = candidates[number].tolist()
            if blocked[row, column]:
                continue
            served.append(number)
            if len(served) >= most:
                return np.array(served)
            # four fractional bits, so that small radii differ as well
            center, extent = (16 * column, 16 * row), int(16 * radii[number])
            cv2.circle(blocked, center, extent, 1, cv2.FILLED, shift=4)
    return np.array(served, dtype=np.int64)
