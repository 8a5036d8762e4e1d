"""A field of motion vectors that can be asked anywhere."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np


@dataclass(frozen=True, eq=False)
class FlowField:
    """Motion over the domain [0, width] x [0, height], on a grid of any resolution.

    Raises:
        ValueError: If `vectors` is not [h, w, 2] float32.
    """

    width: int
    """Width of the domain [px]."""
    height: int
    """Height of the domain [px]."""
    vectors: np.ndarray
    """Motion at the centres of h x w equal cells [px of the domain], shape [h, w, 2] float32."""

    def __post_init__(self) -> None:
        if self.vectors.ndim != 3 or self.vectors.shape[2] != 2 or self.vectors.dtype != np.float32:
            raise ValueError(
                f"a flow's vectors must be [h, w, 2] float32, "
                f"got {self.vectors.shape} {self.vectors.dtype}"
            )

    @classmethod
    def still(cls, width: int, height: int) -> "FlowField":
        """No motion at all."""
        return cls(width, height, np.zeros((1, 1, 2), dtype=np.float32))

    def at(self, points: np.ndarray) -> np.ndarray:
        """Motion at given points, bilinear between cell centres and constant beyond them.

        Args:
            points: Positions [px], shape [N, 2].

        Returns:
            Motion [px], shape [N, 2] float64.
        """
        rows, columns = self.vectors.shape[:2]
        # coordinates apart: numpy is slow where the last axis is a point
        x, x0, x1 = _between(points[:, 0], columns, self.width)
        y, y0, y1 = _between(points[:, 1], rows, self.height)
        motion = np.empty((len(points), 2))
        for axis, plane in enumerate(self._planes):
            upper = (1 - x) * plane[columns * y0 + x0] + x * plane[columns * y0 + x1]
            lower = (1 - x) * plane[columns * y1 + x0] + x * plane[columns * y1 + x1]
            motion[:, axis] = (1 - y) * upper + y * lower
        return motion

    @cached_property
    def _planes(self) -> tuple[np.ndarray, np.ndarray]:
        """Both coordinates of the vectors, row after row, each [h w]."""
        right, down = np.ascontiguousarray(self.vectors.reshape(-1, 2).T)
        return right, down


def _between(
    places: np.ndarray, count: int, length: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where places lie between the centres of equal cells along a side.

    Args:
        places: Along the side [px], shape [N].
        count: Number of cells.
        length: Length of the side [px].

    Returns:
        The part of the way from one centre to the next [0..1], and the cells of both, each [N].
    """
    along = np.clip(places * (count / length) - 0.5, 0, count - 1)
    cells = along.astype(np.int64)
    return along - cells, cells, np.minimum(cells + 1, count - 1)
