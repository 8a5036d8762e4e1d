"""A small description of a picture by which shots are told apart."""

import numpy as np

BLOCKS = (9, 16)
"""Rows and columns of a signature."""
PIXELS_PER_BLOCK = 8
"""Samples across and down that stand for a block: a coarse grid is enough for its mean."""


def signature(pixels: np.ndarray) -> np.ndarray:
    """Mean colours of a coarse grid of blocks.

    Args:
        pixels: Code values, [H, W, 3] uint8.

    Returns:
        Code values, [9, 16, 3] float32.
    """
    rows, columns = BLOCKS
    y = _centres(pixels.shape[0], rows * PIXELS_PER_BLOCK)
    x = _centres(pixels.shape[1], columns * PIXELS_PER_BLOCK)
    samples = pixels[np.ix_(y, x)].astype(np.float32)
    return samples.reshape(rows, PIXELS_PER_BLOCK, columns, PIXELS_PER_BLOCK, 3).mean(axis=(1, 3))


def change(a: np.ndarray, b: np.ndarray) -> float:
    """Mean absolute difference of two signatures [code values]."""
    return float(np.abs(a - b).mean())


def _centres(length: int, count: int) -> np.ndarray:
    """Pixel numbers at the centres of `count` equal parts of `length` pixels."""
    return ((np.arange(count) + 0.5) * length / count).astype(np.int64)
