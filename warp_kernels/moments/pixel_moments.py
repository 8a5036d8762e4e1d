"""What is summed: the moments of one pixel.

`check_size` refuses an image whose sums could leave their integers.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.color_model import SQUARE
from warp_kernels.errors import OptionError
from warp_kernels.limits import MAX_SIDE
from warp_kernels.moments.moment_layout import MomentLayout, moment_types

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def color_sums_of_pixel(layout: MomentLayout) -> Any:
    """A wp.func: the colour moments of a single pixel at (x, y) from the image's middle."""
    types = moment_types(layout)
    sums, integer = types.color, types.integer
    exponents = layout.model.exponents

    @wp.func
    def color_sums(pixel: wp.vec3ub, weight: integer, x: integer, y: integer) -> sums:
        """Each channel times w x^a y^b, and the square of the colour."""
        total = sums()
        for term in range(wp.static(len(exponents))):
            factor = weight
            for _a in range(wp.static(exponents[term][0])):
                factor *= x
            for _b in range(wp.static(exponents[term][1])):
                factor *= y
            for channel in range(3):
                value = integer(pixel[channel])
                total[4 * term + channel] = factor * value
                if term == 0:
                    total[wp.static(SQUARE)] += factor * value * value
        return total

    return color_sums


@cache
def area_sums_of_pixel(layout: MomentLayout) -> Any:
    """A wp.func: the area moments of a single pixel at (x, y) from the image's middle."""
    types = moment_types(layout)
    sums, integer = types.area, types.integer
    exponents = layout.model.area_exponents

    @wp.func
    def area_sums(weight: integer, x: integer, y: integer) -> sums:
        """The weight times x^a y^b."""
        total = sums()
        for term in range(wp.static(len(exponents))):
            factor = weight
            for _a in range(wp.static(exponents[term][0])):
                factor *= x
            for _b in range(wp.static(exponents[term][1])):
                factor *= y
            total[term] = factor
        return total

    return area_sums


def check_size(width: int, height: int) -> None:
    """Refuse an image whose prefix sums could leave int32.

    In the narrow layout the largest entries are the sum of I^2 over a row, 3 * 255^2 * W, and the
    sum of x I with x counted from the middle, 255 * W^2 / 8: both stay below 2^31 up to W = 8192.
    The largest sums over rows, x^2 and I^2, then stay below 2^63 by a factor of a thousand.

    In the wide layout, with weights up to 255, the sums of w, w x, w x^2, w I, w x I and w I^2 over
    a whole picture stay below 2^63 at that size as well, the largest with w x^2 at 10^17. Those of
    higher powers wrap around; `fit` tells which of them can be read.

    Raises:
        OptionError: If a side exceeds MAX_SIDE.
    """
    if max(width, height) > MAX_SIDE:
        raise OptionError(
            f"a picture of {width}x{height} is too large: sides up to {MAX_SIDE} px keep all sums "
            "exact; scale it down first"
        )
