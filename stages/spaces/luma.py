"""Brightness alone: colours that are equally bright are equal."""

from dataclasses import dataclass
from typing import ClassVar

import cv2
import numpy as np

WEIGHTS = (0.2126, 0.7152, 0.0722)
"""Shares of red, green and blue in BT.709's luma Y'."""


@dataclass(frozen=True)
class Luma:
    """The luma Y' of BT.709, of the code values as they are, in all three channels.

    Three times the same value keeps the scale: a grey picture has the energies that it has in
    RGB, so `--error` means the same.

    Source: Recommendation ITU-R BT.709-6, item 3.2.
    """

    scale: ClassVar[float] = 1.0

    def convert(self, pixels: np.ndarray) -> np.ndarray:
        """Turn a picture [H, W, 3] uint8 into its luma, rounded, three times [H, W, 3] uint8."""
        return np.asarray(cv2.transform(pixels, np.array([WEIGHTS] * 3)))
