"""How far the colours of a triangle may go: not beyond the pixels that it covers.

A polynomial that fits a strong edge leaves the range of its pixels, and one that fits a few pixels
leaves it far between and beside them: specks and fringes that the picture does not have.
"""

import numpy as np

from stages.mesh import Mesh, centres_of
from warp_kernels.color_model import ColorModel
from warp_kernels.extremes import BRIGHTEST, DARKEST

SLACK = 12.0
"""Most that a colour may leave the range of the pixels below [code values]."""
REACH = 1.0
"""Tips of triangles reach about so far beyond the centres of their outermost pixels, along x and
along y [px]: there an even slope goes on."""


def limits_of(
    mesh: Mesh, model: ColorModel, coefficients: np.ndarray, extremes: np.ndarray
) -> np.ndarray:
    """The lowest and the highest value of every channel that a triangle may show.

    Args:
        mesh: The triangles.
        model: Fixes the terms.
        coefficients: As in a snapshot, [T, 3, K].
        extremes: Least and largest values of the pixels below [code values], [T, 2, 3] uint8.

    Returns:
        Whole code values, [T, 2, 3] uint8.
    """
    x, y = centres_of(mesh.corners).T
    steepness = np.zeros(coefficients.shape[:2])
    for axis in (0, 1):
        slope = np.zeros_like(steepness)
        for term, (a, b) in enumerate(model.exponents):
            power = (a, b)[axis]
            if power:
                rest = x ** (a - (axis == 0)) * y ** (b - (axis == 1))
                slope += power * rest[:, None] * coefficients[:, :, term]
        steepness += np.abs(slope)
    slack = np.minimum(SLACK, REACH * steepness)
    limits = np.empty(extremes.shape)
    limits[:, 0] = np.floor(extremes[:, DARKEST] - slack)
    limits[:, 1] = np.ceil(extremes[:, BRIGHTEST] + slack)
    return np.clip(limits, 0.0, 255.0).astype(np.uint8)
