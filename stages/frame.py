"""One decoded picture and when it is shown."""

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

WHITE = 255
"""Weight of a pixel whose errors count fully."""


@dataclass(frozen=True, eq=False, slots=True)
class Frame:
    """A picture of the source, upright, in full-range RGB.

    Raises:
        ValueError: If `pixels` is not [H, W, 3] uint8, or `weights` not [H, W] uint8.
    """

    index: int
    """Number of the frame in the source, counted in decoded frames from 0."""
    pts: int
    """Presentation time in units of `time_base`; strictly increases over a clip."""
    time_base: Fraction
    """Seconds per unit of `pts`."""
    pixels: np.ndarray
    """Code values [0..255], shape [H, W, 3] uint8, C-contiguous."""
    weights: np.ndarray | None = None
    """How much an error at each pixel counts [1..WHITE], shape [H, W] uint8; None for all alike."""

    def __post_init__(self) -> None:
        if self.pixels.ndim != 3 or self.pixels.shape[2] != 3 or self.pixels.dtype != np.uint8:
            raise ValueError(
                f"a frame's pixels must be [H, W, 3] uint8, "
                f"got {self.pixels.shape} {self.pixels.dtype}"
            )
        weights = self.weights
        if weights is not None and (
            weights.shape != self.pixels.shape[:2] or weights.dtype != np.uint8
        ):
            raise ValueError(
                f"the weights of a frame of {self.pixels.shape[:2]} must be uint8 of that shape, "
                f"got {weights.shape} {weights.dtype}"
            )

    @property
    def width(self) -> int:
        """Width [px]."""
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        """Height [px]."""
        return int(self.pixels.shape[0])

    def __repr__(self) -> str:
        return f"Frame(index={self.index}, pts={self.pts}, {self.width}x{self.height})"
