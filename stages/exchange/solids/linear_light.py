"""Code values as amounts of light, which is how 3D programs count colours."""

import numpy as np

STEPS = 2.0**24
"""Amounts are whole multiples of the inverse: differences of two are then exact in float32, and no
last bit depends on how a machine computes powers."""


def linear_light(codes: np.ndarray) -> np.ndarray:
    """Amounts of light of sRGB code values.

    Args:
        codes: Code values, 0 to 255, of any shape.

    Returns:
        Linear light, 0 to 1, of the same shape, float32.

    Source: IEC 61966-2-1, sRGB; glTF 2.0, Sec. 3.7.2.1 (COLOR_n is linear).
    """
    share = np.asarray(codes, np.float64) / 255.0
    light = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return (np.rint(light * STEPS) / STEPS).astype(np.float32)
