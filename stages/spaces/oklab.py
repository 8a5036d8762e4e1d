"""Oklab: equal distances look about equally different."""

from dataclasses import dataclass
from functools import cache
from typing import ClassVar

import cv2
import numpy as np

LEVELS = 65535
"""Linear light in the tables: fine enough that the darkest code values stay apart."""
ROOTS = 32767
"""Cube roots in the tables, as int16."""
MIDDLE = 128
"""Code value of a and b that stands for grey."""

TO_CONES = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
"""Linear red, green and blue of sRGB to the responses l, m, s of the eye's cones."""
TO_LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
"""Cube roots of l, m, s to L, a, b."""


@dataclass(frozen=True)
class Oklab:
    """L, a and b on one scale, so that Euclidean distances mean what they mean in Oklab.

    The code values are 255 L, 255 a + 128 and 255 b + 128, rounded; sRGB reaches 68..198 in a and
    49..179 in b, so nothing is clipped. They depend on the pixel alone: the steps between the
    tables are rounded to integers.

    A difference of grey counts in one channel where RGB counts it in three, and less in bright
    tones: on photographs energies are about `scale` of those in RGB (0.23 to 0.25 on three), so
    half of an `--error` in RGB asks for about as many triangles.

    Source: Ottosson, A perceptual color space for image processing (2020),
        https://bottosson.github.io/posts/oklab/
    """

    scale: ClassVar[float] = 0.25

    def convert(self, pixels: np.ndarray) -> np.ndarray:
        """Turn a picture [H, W, 3] uint8 into L, a, b [H, W, 3] uint8."""
        light, roots = _tables()
        cones = cv2.transform(cv2.LUT(pixels, light), TO_CONES)
        lab = cv2.transform(cv2.LUT(cones, roots), _to_codes())
        return lab.astype(np.uint8)


@cache
def _tables() -> tuple[np.ndarray, np.ndarray]:
    """Code value to linear light [256] uint16, linear light to its cube root [65536] int16."""
    codes = np.arange(256) / 255
    # IEC 61966-2-1: a straight line near black, then a power.
    linear = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    roots = np.cbrt(np.arange(LEVELS + 1) / LEVELS)
    return np.rint(LEVELS * linear).astype(np.uint16), np.rint(ROOTS * roots).astype(np.int16)


@cache
def _to_codes() -> np.ndarray:
    """Cube roots to code values, with the offsets of a and b, [3, 4]."""
    return np.column_stack([TO_LAB * (255 / ROOTS), (0, MIDDLE, MIDDLE)])
