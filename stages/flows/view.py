"""A picture as motion is looked for in it."""

import cv2
import numpy as np


class View:
    """A picture in grey and small; what was made once is kept, for two passages meet in a frame.

    Two threads may ask at once: both would make the same.

    Args:
        pixels: Code values, shape [H, W, 3] uint8.
    """

    def __init__(self, pixels: np.ndarray) -> None:
        self.pixels = pixels
        self._reduced: dict[int, np.ndarray] = {}

    @property
    def height(self) -> int:
        """Height of the picture [px]."""
        return int(self.pixels.shape[0])

    @property
    def width(self) -> int:
        """Width of the picture [px]."""
        return int(self.pixels.shape[1])

    def reduced(self, lines: int) -> np.ndarray:
        """The picture in grey, its short side at most this long [px], shape [h, w] uint8."""
        if lines not in self._reduced:
            scale = min(1.0, lines / min(self.height, self.width))
            size = (max(1, round(scale * self.width)), max(1, round(scale * self.height)))
            gray = cv2.cvtColor(self.pixels, cv2.COLOR_RGB2GRAY)  # too large to be kept
            self._reduced[lines] = cv2.resize(gray, size, interpolation=cv2.INTER_AREA)
        return self._reduced[lines]
