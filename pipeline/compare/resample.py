"""Pictures at another size, to compare an output with its source."""

from functools import lru_cache

import numpy as np
from scipy.sparse import csr_array


def resample(pixels: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Scale a picture, bilinear; where it shrinks, the filter widens so that nothing aliases.

    Args:
        pixels: Code values, [H, W, C] uint8.
        size: Wanted width and height [px].

    Returns:
        Code values, [height, width, C] float64; `pixels` itself if it has the size already.
    """
    rows, columns, channels = pixels.shape
    width, height = size
    if (columns, rows) == size:
        return pixels
    down = _weights(rows, height) @ pixels.reshape(rows, -1).astype(np.float64)
    across = down.reshape(height, columns, channels).transpose(1, 0, 2).reshape(columns, -1)
    scaled = (_weights(columns, width) @ across).reshape(width, height, channels)
    return np.ascontiguousarray(scaled.transpose(1, 0, 2))


@lru_cache(maxsize=4)
def _weights(old: int, new: int) -> csr_array:
    """Share of every old sample in every new one, [new, old]; each row sums to 1."""
    step = old / new
    reach = max(step, 1.0)
    centres = (np.arange(new) + 0.5) * step - 0.5
    offsets = np.arange(int(np.ceil(reach)) * 2 + 1) - int(np.ceil(reach))
    places = np.rint(centres)[:, None].astype(np.int64) + offsets
    shares = np.clip(1.0 - np.abs(places - centres[:, None]) / reach, 0.0, None)
    shares /= shares.sum(axis=1, keepdims=True)
    rows = np.repeat(np.arange(new), places.shape[1])
    entries = (rows, np.clip(places, 0, old - 1).ravel())
    return csr_array((shares.ravel(), entries), shape=(new, old))
