"""Which pixels lie in a triangle, by exact rational arithmetic, a row at a time.

The rule, as `warp_kernels/raster.py` states it: vertices are rounded to 1/256 px; an edge crosses
a row when the row's centre lies in [its upper end, its lower end); a pixel is covered when its
centre lies in [left crossing, right crossing).
"""

from collections.abc import Sequence
from fractions import Fraction
from math import ceil, floor

SUBPIXELS = 256
HALF = Fraction(1, 2)

Corner = tuple[Fraction, Fraction]
Pixel = tuple[int, int]
"""Column and row."""


def rounded(x: float, y: float) -> Corner:
    """Round a position [px] to the nearest 1/256 px, halves upwards."""
    return tuple(Fraction(floor(Fraction(c) * SUBPIXELS + HALF), SUBPIXELS) for c in (x, y))


def covered_pixels(corners: Sequence[Corner], width: int, height: int) -> tuple[int, list[Pixel]]:
    """List the pixels of a picture that a triangle covers.

    Returns:
        1 or -1 for a triangle of positive or negative area (0 for none), and the pixels.
    """
    (ax, ay), (bx, by), (cx, cy) = corners
    doubled = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    sign = (doubled > 0) - (doubled < 0)
    pixels = []
    if sign != 0:
        first = max(0, ceil(min(ay, by, cy) - HALF))
        for row in range(first, min(height, ceil(max(ay, by, cy) - HALF))):
            left, right = sorted(_crossings(corners, row + HALF))
            begin, end = max(0, ceil(left - HALF)), min(width, ceil(right - HALF))
            pixels += [(column, row) for column in range(begin, end)]
    return sign, pixels


def _crossings(corners: Sequence[Corner], y: Fraction) -> list[Fraction]:
    """Where the three edges cross the height y [px]: twice inside a triangle."""
    crossings = []
    for start in range(3):
        (ax, ay), (bx, by) = sorted((corners[start], corners[(start + 1) % 3]), key=lambda p: p[1])
        if ay <= y < by:
            crossings.append(ax + (y - ay) * (bx - ax) / (by - ay))
    return crossings
