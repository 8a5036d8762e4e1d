"""Turning stored pictures upright."""

from fractions import Fraction

import numpy as np

MAX_SAMPLE_ASPECT = Fraction(8)
"""Pixels stretched by more than this are taken for a mistake in the file."""


def upright(pixels: np.ndarray, rotation: int) -> np.ndarray:
    """Turn a picture.

    Args:
        pixels: Stored picture, [H, W, C].
        rotation: Counter-clockwise turn [degrees: 0, 90, 180, 270].

    Returns:
        The turned picture, C-contiguous; the argument itself when nothing is to be done.
    """
    return np.ascontiguousarray(np.rot90(pixels, k=rotation // 90)) if rotation else pixels


def quarter_turns(degrees: float) -> int:
    """The nearest multiple of 90 degrees.

    Args:
        degrees: Counter-clockwise turn; any value, negative ones as well.

    Returns:
        0, 90, 180 or 270 [degrees].
    """
    return round(degrees / 90) % 4 * 90


def sane_aspect(stored: Fraction | None, rotation: int) -> Fraction | None:
    """Sample aspect of the upright picture.

    Args:
        stored: Pixel width over height as stored; None or 0 if unknown.
        rotation: Turn that makes the picture upright [degrees: 0, 90, 180, 270].

    Returns:
        The aspect, 1 if unknown; None if the stored one is beyond belief.
    """
    if not stored or stored < 0:
        return Fraction(1)
    if not 1 / MAX_SAMPLE_ASPECT <= stored <= MAX_SAMPLE_ASPECT:
        return None
    return Fraction(1 / stored if rotation in (90, 270) else stored)
