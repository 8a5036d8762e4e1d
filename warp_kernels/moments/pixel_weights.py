"""How much the error of every pixel counts, as the smallest integers of the same ratios."""

import numpy as np


def reduced_weights(weights: np.ndarray, size: tuple[int, int]) -> tuple[np.ndarray, float]:
    """Divide weights by their greatest common divisor, so that equal ones are no weights at all.

    Args:
        weights: 1 to 255, with 0 taken as 1, [H, W] uint8.
        size: Width and height of the picture [px].

    Returns:
        Weights without a common divisor, [H, W] uint8, and their mean.

    Raises:
        ValueError: If the weights do not fit the picture.
    """
    width, height = size
    if weights.shape != (height, width) or weights.dtype != np.uint8:
        raise ValueError(
            f"weights of {weights.shape} {weights.dtype}: must be {(height, width)} uint8"
        )
    counts = np.bincount(weights.reshape(-1), minlength=256)
    values = np.maximum(np.arange(256), 1)
    values //= np.gcd.reduce(values[counts > 0])
    return values.astype(np.uint8)[weights], float(counts @ values) / (width * height)
