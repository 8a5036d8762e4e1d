"""Plates that tumble in space, as they are seen from straight ahead."""

import numpy as np

LAMP = np.array([-0.36, -0.48, 0.8])
"""Where light comes from, as a unit vector: the left, above, and the eye's side."""
DARKEST, BRIGHTEST = 0.35, 1.5
"""Bounds of the light that falls on a plate, at rest 1."""


def tilted(
    axes: np.ndarray, angles: np.ndarray, spins: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Turn plates about axes in the plane of the picture, then in it.

    Args:
        axes: Directions of the axes [rad], [T].
        angles: How far they turn about these [rad], [T].
        spins: How far they turn in the plane of the picture after that [rad], [T].

    Returns:
        What becomes of vectors in them as they are seen, [T, 2, 2], and the light that falls on
        them, relative to that at rest, [T].

    Source: Lambert, Photometria (1760): light by the cosine of its angle.
    """
    cosine, sine = np.cos(angles), np.sin(angles)
    x, y = np.cos(axes), np.sin(axes)
    flat = np.stack(
        [x * x + cosine * y * y, (1.0 - cosine) * x * y, y * y + cosine * x * x], axis=1
    )
    turns = spun(spins)
    # the side that is seen, front or back
    side = np.where(cosine < 0.0, -1.0, 1.0)[:, None]
    normals = side * np.stack([y * sine, -x * sine, cosine], axis=1)
    around = np.einsum("tij,tj->ti", turns, normals[:, :2])
    light = (around @ LAMP[:2] + normals[:, 2] * LAMP[2]) / LAMP[2]
    return turns @ flat[:, [[0, 1], [1, 2]]], np.clip(light, DARKEST, BRIGHTEST)


def spun(angles: np.ndarray) -> np.ndarray:
    """Turns in the plane of the picture, [T, 2, 2].

    Args:
        angles: How far, clockwise as seen [rad], [T].
    """
    cosine, sine = np.cos(angles), np.sin(angles)
    return np.stack([cosine, -sine, sine, cosine], axis=-1).reshape(-1, 2, 2)
