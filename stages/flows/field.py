"""A field of motion vectors that can be asked anywhere."""

from dataclasses import dataclass

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
        last = np.array([self.vectors.shape[1] - 1, self.vectors.shape[0] - 1])
        places = points * ((last + 1) / (self.width, self.height)) - 0.5
        places = np.clip(places, 0, last)
        cells = places.astype(np.int64)
        x0, y0 = cells.T
        x1, y1 = np.minimum(cells + 1, last).T
        right, down = (places - cells).T[:, :, None]
        upper = (1 - right) * self.vectors[y0, x0] + right * self.vectors[y0, x1]
        lower = (1 - right) * self.vectors[y1, x0] + right * self.vectors[y1, x1]
        return (1 - down) * upper + down * lower
