"""What is summed: the moments of one pixel, and of everything left of a column in one row.

Both ways to sum (`edge_moments`, `fragments`) take their terms from here, so they cannot differ.
All sums are int64; `check_size` refuses an image whose sums could leave their integers.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.color_model import ColorModel
from warp_kernels.errors import OptionError
from warp_kernels.raster import MAX_SIDE

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@dataclass(frozen=True)
class MomentTypes:
    """The Warp types of one colour model's sums."""

    color: Any
    """Vector of 4 K int64: for each term the sums for red, green, blue, and I^2 or nothing."""
    area: Any
    """Vector of G int64: the sums of x^a y^b."""
    powers: Any
    """Vector of 2 d + 1 int64: sums of x^a over the pixels left of a column."""


@cache
def moment_types(model: ColorModel) -> MomentTypes:
    """The vector types in which the sums of `model` are kept."""
    return MomentTypes(
        color=wp.types.vector(length=4 * model.term_count, dtype=wp.int64),
        area=wp.types.vector(length=model.area_count, dtype=wp.int64),
        powers=wp.types.vector(length=2 * model.degree + 1, dtype=wp.int64),
    )


@cache
def color_sums_left_of(model: ColorModel) -> Any:
    """A wp.func: the colour moments of all pixels of a row left of a column.

    It reads the prefix table (see `image_tables`) at `entry`, the place of that row and column,
    and multiplies by the powers of `y`, the row's number from the image's middle.
    """
    sums = moment_types(model).color

    if model.degree == 0:

        @wp.func
        def color_sums(table: wp.array(dtype=wp.vec4i), entry: int, y: wp.int64) -> sums:
            t = table[entry]
            return sums(wp.int64(t[0]), wp.int64(t[1]), wp.int64(t[2]), wp.int64(t[3]))

    elif model.degree == 1:

        @wp.func
        def color_sums(table: wp.array(dtype=wp.vec4i), entry: int, y: wp.int64) -> sums:
            t = table[entry]
            u = table[entry + 1]
            red = wp.int64(t[0])
            green = wp.int64(t[1])
            blue = wp.int64(t[2])
            return sums(
                red,
                green,
                blue,
                wp.int64(t[3]),
                wp.int64(u[0]),
                wp.int64(u[1]),
                wp.int64(u[2]),
                wp.int64(u[3]),
                y * red,
                y * green,
                y * blue,
                wp.int64(0),
            )

    return color_sums


@cache
def area_sums_left_of(model: ColorModel) -> Any:
    """A wp.func: the area moments of all pixels of a row left of a column.

    `powers` holds the sums of x^a left of that column (see `column_powers`), `y` is the row's
    number from the image's middle.
    """
    types = moment_types(model)
    sums, powers_type = types.area, types.powers

    if model.degree == 0:

        @wp.func
        def area_sums(powers: powers_type, y: wp.int64) -> sums:
            return sums(powers[0])

    elif model.degree == 1:

        @wp.func
        def area_sums(powers: powers_type, y: wp.int64) -> sums:
            y_count = y * powers[0]
            return sums(powers[0], powers[1], y_count, powers[2], y * powers[1], y * y_count)

    return area_sums


@cache
def color_sums_of_pixel(model: ColorModel) -> Any:
    """A wp.func: the colour moments of a single pixel at (x, y) from the image's middle."""
    sums = moment_types(model).color
    exponents = model.exponents

    @wp.func
    def color_sums(pixel: wp.vec3ub, x: wp.int64, y: wp.int64) -> sums:
        total = sums()
        for term in range(wp.static(len(exponents))):
            factor = wp.int64(1)
            for _a in range(wp.static(exponents[term][0])):
                factor *= x
            for _b in range(wp.static(exponents[term][1])):
                factor *= y
            for channel in range(3):
                value = wp.int64(pixel[channel])
                total[4 * term + channel] = factor * value
                if term == 0:
                    total[3] += value * value
        return total

    return color_sums


def column_powers(width: int, model: ColorModel) -> np.ndarray:
    """Sums of x^a over the pixels left of every column, x counted from the image's middle.

    Returns:
        Shape [W + 1, 2 d + 1] int64.
    """
    x = np.arange(width, dtype=np.int64) - width // 2
    sums = np.zeros((width + 1, 2 * model.degree + 1), dtype=np.int64)
    for power in range(2 * model.degree + 1):
        np.cumsum(x**power, out=sums[1:, power])
    return sums


def check_size(width: int, height: int) -> None:
    """Refuse an image whose prefix sums could leave int32.

    The largest entries are the sum of I^2 over a row, 3 * 255^2 * W, and the sum of x I with x
    counted from the middle, 255 * W^2 / 8: both stay below 2^31 up to W = 8192. The largest
    sums over rows, x^2 and I^2, then stay below 2^63 by a factor of a thousand.

    Raises:
        OptionError: If a side exceeds MAX_SIDE.
    """
    if max(width, height) > MAX_SIDE:
        raise OptionError(
            f"a picture of {width}x{height} is too large: sides up to {MAX_SIDE} px keep all sums "
            "exact; scale it down first"
        )
