"""A picture as brightness."""

import numpy as np

from stages.media import open_decoder
from stages.media.embedded import is_embedded, read_embedded

LUMA = (0.2126, 0.7152, 0.0722)
"""Weights of red, green and blue in grey, as BT.709 has them."""


def read_gray(path: str) -> np.ndarray:
    """The first frame of a picture as grey.

    Args:
        path: What FFmpeg reads, or a picture itself, see `embedded`.

    Returns:
        Brightness, 0 (black) to 1 (white), [h, w] float64.

    Raises:
        MediaError: If it cannot be read.
        OptionError: If it is a picture itself, and a damaged one.
    """
    if is_embedded(path):
        return gray_of(read_embedded(path))
    with open_decoder(path) as decoder:
        return gray_of(next(decoder).pixels)


def gray_of(pixels: np.ndarray) -> np.ndarray:
    """Brightness of code values [h, w, 3], 0 (black) to 1 (white), [h, w] float64."""
    return pixels @ np.array(LUMA) / 255.0
