"""The best colour of a set of pixels and the error it leaves: Eqs. 2-4 and 13-15 in float64."""

from collections.abc import Sequence

import numpy as np

from tests.oracles.coverage import Pixel
from warp_kernels.color_model import ColorModel


def best_fit(
    picture: np.ndarray, pixels: Sequence[Pixel], model: ColorModel
) -> tuple[np.ndarray, float]:
    """Fit the polynomial by least squares; the constant where the system is singular.

    Energies are sums over pixels, without the 1/q of Eq. 13, so that they add up as Eq. 12 needs.

    Returns:
        Fitted colour of every pixel [code values], [q, 3], and E [code value^2 px].
    """
    if not pixels:
        return np.zeros((0, 3)), 0.0
    columns, rows = np.array(pixels).T
    colors = picture[rows, columns].astype(np.float64)
    if model.degree == 0 or is_singular(pixels):
        fitted = np.broadcast_to(colors.mean(axis=0), colors.shape)  # Eq. 14
    else:
        matrix = np.stack([columns - columns.mean(), rows - rows.mean(), np.ones(len(pixels))], 1)
        fitted = matrix @ np.linalg.lstsq(matrix, colors, rcond=None)[0]  # Eq. 15
    return fitted, 0.5 * float(((colors - fitted) ** 2).sum())  # Eq. 4


def is_singular(pixels: Sequence[Pixel]) -> bool:
    """Say whether the matrix of Eq. 15 has no inverse: all pixels on a line; exact."""
    (x0, y0), away = pixels[0], pixels[-1]
    ux, uy = away[0] - x0, away[1] - y0
    return all(ux * (y - y0) == uy * (x - x0) for x, y in pixels)
