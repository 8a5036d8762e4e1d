"""Where a picture has detail: the maps that the related tools place their vertices by."""

import cv2
import numpy as np

ANYWHERE = 40_000
"""Pixels drawn to fill a picture: some fifty for each vertex of the finest meshes."""


def luma(pixels: np.ndarray) -> np.ndarray:
    """Brightness [code values], [H, W] float32, of pixels [H, W, 3] uint8."""
    return cv2.cvtColor(pixels, cv2.COLOR_RGB2GRAY).astype(np.float32)


def gradient(pixels: np.ndarray, blur: float) -> np.ndarray:
    """Length of the gradient, the strongest channel's, [H, W] float32 [code values / px].

    Args:
        pixels: The picture, [H, W, 3] uint8.
        blur: Standard deviation of the Gaussian before it [px].
    """
    smooth = cv2.GaussianBlur(pixels, (0, 0), blur).astype(np.float32)
    across = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=1 / 8)
    down = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=1 / 8)
    return np.sqrt(across**2 + down**2).max(axis=2)


def edges(pixels: np.ndarray, blur: float, share: float) -> np.ndarray:
    """Canny's edges, [H, W] bool.

    Args:
        pixels: The picture, [H, W, 3] uint8.
        blur: Standard deviation of the Gaussian before it [px].
        share: Part of the pixels whose gradient passes the upper threshold.
    """
    smooth = cv2.GaussianBlur(luma(pixels), (0, 0), blur).clip(0, 255).astype(np.uint8)
    across, down = (cv2.Sobel(smooth, cv2.CV_32F, *axis) for axis in ((1, 0), (0, 1)))
    # a picture with few edges has less than its share of them
    high = max(20.0, float(np.quantile(np.hypot(across, down), 1 - share)))
    return cv2.Canny(smooth, 0.4 * high, high, L2gradient=True) > 0


def positions(columns_rows: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Pixels (column, row) as random positions within them [px], [N, 2]."""
    return columns_rows + rng.uniform(0.2, 0.8, columns_rows.shape)


def pixels_anywhere(size: tuple[int, int], rng: np.random.Generator) -> np.ndarray:
    """Pixels (column, row) drawn evenly, [N, 2] int; enough to leave no hole between vertices.

    Args:
        size: Width and height of the picture [px].
        rng: Source of the draws.
    """
    return rng.integers(size, size=(min(ANYWHERE, 2 * size[0] * size[1]), 2))


def pixels_where(mask: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """The pixels (column, row) of a mask [H, W] in random order, [N, 2] int."""
    return rng.permutation(np.argwhere(mask)[:, ::-1])


def drawn_by(weights: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Pixels (column, row) drawn without replacement in proportion to weights, [N, 2] int.

    Args:
        weights: Above 0 where a pixel may be drawn, [H, W].
        count: Pixels to draw at most.
        rng: Source of the draws.

    Source: Efraimidis & Spirakis, Weighted random sampling with a reservoir (2006).
    """
    keys = rng.exponential(size=weights.shape) / np.maximum(weights, 1e-30)
    first = np.argsort(keys, axis=None, kind="stable")[:count]
    rows, columns = np.unravel_index(first, weights.shape)
    return np.stack([columns, rows], axis=1)
