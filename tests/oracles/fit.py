"""The best colour of a set of pixels and the error it leaves: Eqs. 2-4 and 13-15."""

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from tests.oracles.coverage import Pixel
from warp_kernels.color_model import CHANNELS, ColorModel


def best_fit(
    picture: np.ndarray,
    pixels: Sequence[Pixel],
    model: ColorModel,
    weights: np.ndarray | None = None,
) -> tuple[np.ndarray, float]:
    """Fit the polynomial by least squares in float64, of a lower degree where that is singular.

    Energies are sums over pixels, without the 1/q of Eq. 13, so that they add up as Eq. 12 needs.

    Args:
        picture: Code values, [H, W, 3] uint8.
        pixels: The pixels covered.
        model: The polynomial colour.
        weights: How much each pixel counts, [H, W]; None for 1.

    Returns:
        Fitted colour of every pixel [code values], [q, 3], and E [code value^2 px].
    """
    if not pixels:
        return np.zeros((0, 3)), 0.0
    degree = model.degree
    while is_singular(pixels, degree):
        degree -= 1
    columns, rows = np.array(pixels).T
    colors = picture[rows, columns].astype(np.float64)
    weight = np.ones(len(pixels)) if weights is None else weights[rows, columns].astype(float)
    x, y = (values - values.mean() for values in (columns, rows))
    matrix = np.stack([x**a * y**b for a, b in ColorModel("", degree).exponents], axis=1)
    matrix /= np.maximum(np.abs(matrix).max(axis=0), 1e-300)
    root = np.sqrt(weight)[:, None]
    fitted = matrix @ np.linalg.lstsq(root * matrix, root * colors, rcond=None)[0]  # Eq. 15
    return fitted, 0.5 * float((weight[:, None] * (colors - fitted) ** 2).sum())  # Eq. 4


def exact_energy(
    picture: np.ndarray, pixels: Sequence[Pixel], model: ColorModel, weights: np.ndarray | None
) -> float:
    """The least E of Eq. 4 in rational arithmetic; the matrix must be regular.

    Eliminating from Eq. 15 bordered by its right-hand side and the sum of I^2 leaves the residual.

    Args:
        picture: Code values, [H, W, 3] uint8.
        pixels: The pixels covered.
        model: The polynomial colour.
        weights: How much each pixel counts, [H, W]; None for 1.
    """
    (x0, y0), total = pixels[0], Fraction(0)
    factors = [1 if weights is None else int(weights[y, x]) for x, y in pixels]
    for channel in range(CHANNELS):
        terms = np.array(
            [
                *([(x - x0) ** a * (y - y0) ** b for x, y in pixels] for a, b in model.exponents),
                [int(picture[y, x, channel]) for x, y in pixels],
            ],
            dtype=object,
        )
        bordered = [[Fraction(int(v)) for v in row] for row in (terms * factors) @ terms.T]
        for n in range(model.term_count):
            assert _eliminate(bordered, n) > 0
        total += bordered[-1][-1]
    return float(total / 2)


def is_singular(pixels: Sequence[Pixel], degree: int) -> bool:
    """Say whether the matrix of Eq. 15 has no inverse; exact.

    With a linear colour that is the case when all pixels lie on a line, with a quadratic one when
    they lie on a conic, and always when there are fewer pixels than terms.
    """
    if len(pixels) < len(ColorModel("", degree).exponents):
        return True
    matrix = normal_matrix(pixels, degree)
    return any(_eliminate(matrix, n) == 0 for n in range(len(matrix)))


def normal_matrix(pixels: Sequence[Pixel], degree: int) -> list[list[Fraction]]:
    """The matrix of Eq. 15 with x and y counted from the first pixel, [K][K]."""
    x0, y0 = pixels[0]
    terms = np.array(
        [
            [(x - x0) ** a * (y - y0) ** b for a, b in ColorModel("", degree).exponents]
            for x, y in pixels
        ],
        dtype=object,
    )
    return [[Fraction(int(value)) for value in row] for row in terms.T @ terms]


def _eliminate(matrix: list[list[Fraction]], n: int) -> Fraction:
    """Clear column n below the diagonal; give the pivot."""
    pivot = matrix[n][n]
    for row in matrix[n + 1 :] if pivot else []:
        factor = row[n] / pivot
        row[:] = [value - factor * above for value, above in zip(row, matrix[n], strict=True)]
    return pivot
