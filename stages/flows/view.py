"""A picture as motion is looked for in it."""

import cv2
import numpy as np

COARSE = 360
"""The short side of a coarse picture is at least so long [px], and less than twice as long."""


class View:
    """A picture in grey and small; what was made once is kept, for two passages meet in a frame.

    Two threads may ask at once: both would make the same.

    Args:
        pixels: Code values, shape [H, W, 3] uint8.
    """

    def __init__(self, pixels: np.ndarray) -> None:
        self.pixels = pixels
        self._coarse: np.ndarray | None = None
        self._reduced: dict[int, np.ndarray] = {}

    @property
    def height(self) -> int:
        """Height of the picture [px]."""
        return int(self.pixels.shape[0])

    @property
    def width(self) -> int:
        """Width of the picture [px]."""
        return int(self.pixels.shape[1])

    @property
    def coarse(self) -> np.ndarray:
        """The picture with squares of pixels averaged, or as it is if it is small, [h, w, 3] uint8.

        A large picture is looked through once for all that asks for a small one: by whole numbers
        it takes a fifth of the time that others do.
        """
        if self._coarse is None:
            factor = min(self.height, self.width) // COARSE
            self._coarse = self.pixels
            if factor > 1:
                size = (self.width // factor, self.height // factor)
                self._coarse = cv2.resize(self.pixels, size, interpolation=cv2.INTER_AREA)
        return self._coarse

    def reduced(self, lines: int) -> np.ndarray:
        """The picture in grey, its short side at most this long [px], shape [h, w] uint8."""
        if lines not in self._reduced:
            scale = min(1.0, lines / min(self.height, self.width))
            size = (max(1, round(scale * self.width)), max(1, round(scale * self.height)))
            large = self.coarse if 2 * lines <= COARSE else self.pixels
            gray = cv2.cvtColor(large, cv2.COLOR_RGB2GRAY)  # too large to be kept
            self._reduced[lines] = cv2.resize(gray, size, interpolation=cv2.INTER_AREA)
        return self._reduced[lines]
