"""E_warp: how much changes that does not move with the source."""

import numpy as np

from stages.metrics.motion import SourceMotion
from stages.metrics.warp import warped
from warp_kernels.color_model import CHANNELS

WHITE = 255.0
"""Code value of the colour 1."""


def warp_error(earlier: np.ndarray, later: np.ndarray, motion: SourceMotion) -> float | None:
    """Mean squared difference between a picture and a later one brought back to it.

    Args:
        earlier: A picture of the output (or of the source itself), code values, [H, W, 3].
        later: A later one of the same size.
        motion: Motion of the source between the two.

    Returns:
        Mean over channels and over the pixels that both show, colours in [0, 1]; None if there
        is no such pixel.

    Source: Lai et al., Learning Blind Video Temporal Consistency (2018).
    """
    seen = motion.visible
    if not seen.any():
        return None
    difference = warped(later.astype(np.float32), motion.steps) - earlier.astype(np.float32)
    squares = np.einsum("hwc,hwc->hw", difference, difference)[seen]
    return float(squares.mean(dtype=np.float64) / (CHANNELS * WHITE**2))
