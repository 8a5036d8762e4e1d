"""Sums over the pixels of a triangle (App. A, Eqs. 13-15), one pixel at a time."""

from collections.abc import Sequence

import numpy as np

from tests.oracles.coverage import Pixel
from warp_kernels.color_model import CHANNELS, SQUARE, ColorModel


def moments(
    picture: np.ndarray,
    pixels: Sequence[Pixel],
    model: ColorModel,
    sign: int = 1,
    weights: np.ndarray | None = None,
) -> tuple[list[int], list[int]]:
    """Sum x^a y^b I and x^a y^b over pixels, x and y counted from the middle of the picture.

    Args:
        picture: Code values, [H, W, 3] uint8.
        pixels: The pixels covered.
        model: Fixes the powers and their order.
        sign: -1 for a triangle that is turned inside out.
        weights: A factor for every pixel, [H, W] uint8; None for 1.

    Returns:
        Colour moments [4 K] and area moments [G], Python integers.
    """
    color = [0] * (4 * model.term_count)
    area = [0] * model.area_count
    for column, row in pixels:
        x, y = column - picture.shape[1] // 2, row - picture.shape[0] // 2
        values = [int(value) for value in picture[row, column]]
        factor = sign if weights is None else sign * int(weights[row, column])
        for term, (a, b) in enumerate(model.exponents):
            for channel in range(CHANNELS):
                color[4 * term + channel] += factor * x**a * y**b * values[channel]
        color[SQUARE] += factor * sum(value**2 for value in values)
        for term, (a, b) in enumerate(model.area_exponents):
            area[term] += factor * x**a * y**b
    return color, area
