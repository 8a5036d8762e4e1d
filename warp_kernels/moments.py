"""What is summed: the moments of one pixel, and of everything left of a column in one row.

Both ways to sum (`edge_moments`, `fragments`) take their terms from here, so they cannot differ.
All sums are int64; `check_size` refuses an image whose sums could leave their integers.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.color_model import SQUARE, ColorModel
from warp_kernels.errors import OptionError
from warp_kernels.image_tables import BLOCK_ROWS
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
def row_adders(model: ColorModel) -> tuple[Any, Any]:
    """Two wp.funcs: add what lies left of a column to the running sums of a walk down the rows.

    The sum of x^a y^b is reached without a multiplication: that of x^a y^(b - 1) is added to it
    in every row, so that rows count 1, 2, 3, ... times from the last one upwards; `settle_sums`
    turns such counts into powers of y.
    """
    types = moment_types(model)
    color_type, area_type = types.color, types.area
    color_steps = _running_order(model.exponents)
    area_steps = _running_order(model.area_exponents)
    words = 4 * model.table_depth * BLOCK_ROWS

    # the prefix table comes as plain int32: four of them are widened by one instruction
    @wp.func
    def add_color(sums: color_type, line: wp.array(dtype=int), column: int) -> color_type:
        """Add the pixels left of a column; `line` begins at a row's first entry in its block."""
        for n in range(wp.static(len(color_steps))):
            for channel in range(4):
                if wp.static(color_steps[n][1] < 0):
                    sums[wp.static(4 * color_steps[n][0]) + channel] += wp.int64(
                        line[wp.static(words) * column + wp.static(4 * color_steps[n][2]) + channel]
                    )
                else:
                    sums[wp.static(4 * color_steps[n][0]) + channel] += sums[
                        wp.static(4 * color_steps[n][1]) + channel
                    ]
        return sums

    @wp.func
    def add_area(sums: area_type, column: int) -> area_type:
        """Add the powers of a column from 1 on; `sum_left_of` makes sums of x^a of them."""
        for n in range(wp.static(len(area_steps))):
            if wp.static(area_steps[n][1] < 0):
                sums[wp.static(area_steps[n][0])] += column_power(column, wp.static(n + 1))
            else:
                sums[wp.static(area_steps[n][0])] += sums[wp.static(area_steps[n][1])]
        return sums

    return add_color, add_area


@cache
def color_settler(model: ColorModel) -> Any:
    """A wp.func: turn the running sums of a walk into colour moments.

    With m the rows from a row to the end, 1 for the last, the running sums hold t, m t and
    m (m + 1) / 2 t for b = 0, 1, 2. A row's number is y = end - m.
    """
    color_type = moment_types(model).color
    sources = _sources(model.exponents)

    @wp.func
    def settle_color(
        sums: color_type, end: wp.int64, sign: wp.int64, nothing: wp.int64
    ) -> color_type:
        """Colour moments; `nothing` is 0, but the compiler must not know.

        It would leave out the unused fourth components and add the other three one by one.
        """
        settled = color_type()
        for term in range(wp.static(len(sources))):
            for channel in range(4):
                factor = sign
                if wp.static(term > 0 and channel == SQUARE):
                    factor = nothing
                settled[4 * term + channel] = factor * power_of_row(
                    wp.static(sources[term][3]),
                    sums[wp.static(4 * sources[term][0]) + channel],
                    sums[wp.static(4 * sources[term][1]) + channel],
                    sums[wp.static(4 * sources[term][2]) + channel],
                    end,
                )
        return settled

    return settle_color


@cache
def area_settler(model: ColorModel) -> Any:
    """A wp.func: turn the running sums of a walk into area moments, see `color_settler`."""
    area_type = moment_types(model).area
    exponents = model.area_exponents
    sources = _sources(exponents)
    columns = tuple(
        tuple(model.area_moment(min(lower, a), b) for lower in range(3)) for a, b in exponents
    )

    @wp.func
    def settle_area(sums: area_type, end: wp.int64, middle: wp.int64, sign: wp.int64) -> area_type:
        """Area moments; `middle` is the column from which x counts."""
        powers = area_type()
        for term in range(wp.static(len(sources))):
            powers[term] = sign * power_of_row(
                wp.static(sources[term][3]),
                sums[wp.static(sources[term][0])],
                sums[wp.static(sources[term][1])],
                sums[wp.static(sources[term][2])],
                end,
            )
        settled = area_type()
        for term in range(wp.static(len(columns))):
            settled[term] = sum_left_of(
                wp.static(exponents[term][0]),
                powers[wp.static(columns[term][0])],
                powers[wp.static(columns[term][1])],
                powers[wp.static(columns[term][2])],
                middle,
            )
        return settled

    return settle_area


@wp.func
def power_of_row(
    b: int, once: wp.int64, twice: wp.int64, thrice: wp.int64, end: wp.int64
) -> wp.int64:
    """The sum of y^b t, for b up to 2, from t summed once, twice and three times over."""
    if b == 0:
        return once
    if b == 1:
        return end * once - twice
    return end * (end * once - wp.int64(2) * twice) + wp.int64(2) * thrice - twice


@wp.func
def column_power(column: int, exponent: int) -> wp.int64:
    """A power of a column, exponent 1 to 3; factors of 32 bits are multiplied four at a time."""
    if exponent == 1:
        return wp.int64(column)
    square = wp.int64(column * column)  # below 2^27, see MAX_SIDE
    if exponent == 2:
        return square
    return square * wp.int64(column)


@wp.func
def sum_left_of(a: int, c: wp.int64, c_2: wp.int64, c_3: wp.int64, middle: wp.int64) -> wp.int64:
    """The sum of (x - middle)^a over 0 <= x < c, for a up to 2, from c, c^2 and c^3; exact."""
    if a == 0:
        return c
    if a == 1:
        return (c_2 - c) / wp.int64(2) - middle * c
    squares = (wp.int64(2) * c_3 - wp.int64(3) * c_2 + c) / wp.int64(6)
    return squares - middle * (c_2 - c - middle * c)


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
            """Read the one entry that a constant colour needs."""
            t = table[entry]
            return sums(wp.int64(t[0]), wp.int64(t[1]), wp.int64(t[2]), wp.int64(t[3]))

    elif model.degree == 1:

        @wp.func
        def color_sums(table: wp.array(dtype=wp.vec4i), entry: int, y: wp.int64) -> sums:
            """Read two entries, of power 0 and 1, and multiply the first by y."""
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
            """The pixels left of the column."""
            return sums(powers[0])

    elif model.degree == 1:

        @wp.func
        def area_sums(powers: powers_type, y: wp.int64) -> sums:
            """The sums of 1, x, y, x^2, x y and y^2, as `ColorModel.area_exponents` orders them."""
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
        """Each channel times x^a y^b, and the square of the colour."""
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


def _running_order(exponents: tuple[tuple[int, int], ...]) -> tuple[tuple[int, int, int], ...]:
    """In which order the running sums of x^a y^b grow, a lower b before a higher one.

    Returns:
        Rows of the term, the term of x^a y^(b - 1) or -1 where b = 0, and a.
    """
    ordered = sorted(enumerate(exponents), key=lambda item: item[1][1])
    return tuple((term, exponents.index((a, b - 1)) if b else -1, a) for term, (a, b) in ordered)


def _sources(exponents: tuple[tuple[int, int], ...]) -> tuple[tuple[int, int, int, int], ...]:
    """For every term x^a y^b the terms of x^a, x^a y, x^a y^2 as far as b needs them, and b."""
    return tuple(
        (*(exponents.index((a, min(lower, b))) for lower in range(3)), b) for a, b in exponents
    )
