"""Single colours in Oklab and back, in numbers that are not rounded."""

import numpy as np

from stages.spaces.oklab import TO_CONES, TO_LAB

FROM_CONES, FROM_LAB = np.linalg.inv(TO_CONES), np.linalg.inv(TO_LAB)
"""The ways back."""


def to_lab(codes: np.ndarray) -> np.ndarray:
    """Colours as L, a, b.

    Beyond 0 and 255 the curves go on, black being their middle: what lies there is no colour yet,
    but may become one.

    Args:
        codes: Red, green and blue [code values], [..., 3].

    Returns:
        L (0 to 1), a and b, [..., 3].
    """
    size = np.abs(codes) / 255.0
    linear = np.where(size <= 0.04045, size / 12.92, ((size + 0.055) / 1.055) ** 2.4)
    return _turned(np.cbrt(_turned(np.copysign(linear, codes), TO_CONES)), TO_LAB)


def to_codes(lab: np.ndarray) -> np.ndarray:
    """The way back; what no screen shows lies below 0 or above 255.

    Args:
        lab: L, a and b, [..., 3].

    Returns:
        Red, green and blue [code values], [..., 3].
    """
    light = _turned(_turned(lab, FROM_LAB) ** 3, FROM_CONES)
    size = np.abs(light)
    root = 1.055 * np.maximum(size, 1e-9) ** (1 / 2.4) - 0.055
    code = np.where(size <= 0.0031308, 12.92 * size, root)
    return np.asarray(255.0 * np.copysign(code, light))


def _turned(values: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """A matrix times vectors [..., 3], term by term: the same bits for one as for many."""
    x, y, z = values[..., 0, None], values[..., 1, None], values[..., 2, None]
    turned: np.ndarray = x * matrix[:, 0] + y * matrix[:, 1] + z * matrix[:, 2]
    return turned
