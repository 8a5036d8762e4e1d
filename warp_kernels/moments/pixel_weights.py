"""How much the error of every pixel counts, as the smallest integers of the same ratios."""

import numpy as np
import warp as wp

from warp_kernels.device.device import Device


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


def write_weights(
    device: Device,
    weights: np.ndarray | None,
    size: tuple[int, int],
    *,
    weights_out: wp.array,
    gauge_out: wp.array,
) -> None:
    """Write weights without a common divisor, and the scale of the energies they lead to.

    Args:
        device: Where the arrays are.
        weights: 1 to 255 with 0 taken as 1, [H, W] uint8; None for all alike.
        size: Width and height of the picture [px].
        weights_out: [H, W] uint8, or [1, 1] where there are never any.
        gauge_out: One over the mean weight, and the middle of the picture [px], [1] vec3d.
    """
    width, height = size
    reduced, mean = np.ones(weights_out.shape, dtype=np.uint8), 1.0
    if weights is not None:
        reduced, mean = reduced_weights(weights, size)
    device.write(weights_out, reduced)
    device.write(gauge_out, np.array([[1.0 / mean, width // 2, height // 2]]))
