"""Colours between two others: mixed in Oklab, so that the way looks even and stays clean."""

from functools import cache

import numpy as np

from stages.spaces.oklab import TO_CONES, TO_LAB
from warp_kernels.styles.color import parse_color

_FROM_LAB, _FROM_CONES = np.linalg.inv(TO_LAB), np.linalg.inv(TO_CONES)


def mixed(first: str, second: str, share: float) -> str:
    """A colour between two.

    Args:
        first: As people write colours.
        second: The same.
        share: How much of the second, 0 to 1; beyond these the colours at the ends.

    Returns:
        `#rrggbb`.
    """
    if share <= 0.0 or share >= 1.0:
        return first if share <= 0.0 else second
    lab = (1.0 - share) * _lab_of(first) + share * _lab_of(second)
    light = np.clip(_FROM_CONES @ (_FROM_LAB @ lab) ** 3, 0.0, 1.0)
    code = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return "#{:02x}{:02x}{:02x}".format(*(int(value) for value in np.rint(255 * code)))


@cache
def _lab_of(color: str) -> np.ndarray:
    """L, a, b of a colour, see `stages.spaces.oklab`."""
    code = np.array(parse_color(color)) / 255
    light = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
    return np.asarray(TO_LAB @ np.cbrt(TO_CONES @ light))
