"""The sums of a walk down an edge, row by row without a multiplication, and what they amount to.

The sum of x^a y^b is reached by adding that of x^a y^(b - 1) to it in every row, so that rows count
1, 2, 3, ... times from the last one upwards. With m the rows from a row to the end, 1 for the last,
the running sums of t hold t, m t, m (m + 1) / 2 t, ... for b = 0, 1, 2, ... A row's number is
y = end - m; settling turns such counts into powers of y.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.color_model import SQUARE
from warp_kernels.moments.moment_layout import ENTRY, MomentLayout, moment_types
from warp_kernels.moments.prefix_tables import BLOCK_ROWS

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def color_adder(layout: MomentLayout) -> Any:
    """A wp.func: add the colours left of a column to the running sums of a walk."""
    types = moment_types(layout)
    color_type, integer, word = types.color, types.integer, types.word
    steps = running_order(layout.model.exponents)
    words = ENTRY * layout.depth * BLOCK_ROWS

    # the prefix table comes as plain integers: four of them are widened by one instruction
    @wp.func
    def add_color(sums: color_type, line: wp.array(dtype=word), column: int) -> color_type:
        """Add the pixels left of a column; `line` begins at a row's first entry in its block."""
        for n in range(wp.static(len(steps))):
            for channel in range(4):
                if wp.static(steps[n][1] < 0):
                    sums[wp.static(4 * steps[n][0]) + channel] += integer(
                        line[wp.static(words) * column + wp.static(ENTRY * steps[n][2]) + channel]
                    )
                else:
                    sums[wp.static(4 * steps[n][0]) + channel] += sums[
                        wp.static(4 * steps[n][1]) + channel
                    ]
        return sums

    return add_color


@cache
def area_adder(layout: MomentLayout) -> Any:
    """A wp.func: add the area left of a column to the running sums of a walk."""
    types = moment_types(layout)
    area_type, word = types.area, types.word
    steps = running_order(layout.model.area_exponents)
    area_words = layout.area_words
    words = ENTRY * layout.depth * BLOCK_ROWS
    wide = layout.wide

    @wp.func
    def add_area(sums: area_type, line: wp.array(dtype=word), column: int) -> area_type:
        """Add what the table holds, or the column's powers from 1 on, see `sum_left_of`."""
        for n in range(wp.static(len(steps))):
            if wp.static(steps[n][1] < 0):
                if wp.static(wide):
                    index = wp.static(words) * column + wp.static(area_words[steps[n][2]])
                    sums[wp.static(steps[n][0])] += line[index]
                else:
                    sums[wp.static(steps[n][0])] += column_power(column, wp.static(n + 1))
            else:
                sums[wp.static(steps[n][0])] += sums[wp.static(steps[n][1])]
        return sums

    return add_area


@cache
def color_settler(layout: MomentLayout) -> Any:
    """A wp.func: turn the running sums of a walk into colour moments."""
    types = moment_types(layout)
    color_type, integer = types.color, types.integer
    sources = _sources(layout.model.exponents)
    power_of_row = row_powers(integer)

    @wp.func
    def settle_color(sums: color_type, end: integer, sign: integer, nothing: integer) -> color_type:
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
                    wp.static(sources[term][5]),
                    sums[wp.static(4 * sources[term][0]) + channel],
                    sums[wp.static(4 * sources[term][1]) + channel],
                    sums[wp.static(4 * sources[term][2]) + channel],
                    sums[wp.static(4 * sources[term][3]) + channel],
                    sums[wp.static(4 * sources[term][4]) + channel],
                    end,
                )
        return settled

    return settle_color


@cache
def area_settler(layout: MomentLayout) -> Any:
    """A wp.func: turn the running sums of a walk into area moments."""
    types = moment_types(layout)
    area_type, integer = types.area, types.integer
    exponents = layout.model.area_exponents
    sources = _sources(exponents)
    columns = tuple(
        tuple(layout.model.area_moment(min(lower, a), b) for lower in range(3))
        for a, b in exponents
    )
    power_of_row = row_powers(integer)

    @wp.func
    def settle_rows(sums: area_type, end: integer, sign: integer) -> area_type:
        """The sums of y^b times what was added in every row."""
        settled = area_type()
        for term in range(wp.static(len(sources))):
            settled[term] = sign * power_of_row(
                wp.static(sources[term][5]),
                sums[wp.static(sources[term][0])],
                sums[wp.static(sources[term][1])],
                sums[wp.static(sources[term][2])],
                sums[wp.static(sources[term][3])],
                sums[wp.static(sources[term][4])],
                end,
            )
        return settled

    @wp.func
    def settle_wide(sums: area_type, end: integer, middle: integer, sign: integer) -> area_type:
        """Area moments: the table holds the powers of x already."""
        return settle_rows(sums, end, sign)

    @wp.func
    def settle_narrow(sums: area_type, end: integer, middle: integer, sign: integer) -> area_type:
        """Area moments from powers of columns; `middle` is the column from which x counts."""
        powers = settle_rows(sums, end, sign)
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

    return settle_wide if layout.wide else settle_narrow


@cache
def row_powers(integer: Any) -> Any:
    """A wp.func: the sum of y^b t over rows, from the running sums of t; for one integer type."""

    @wp.func
    def power_of_row(
        b: int,
        once: integer,
        twice: integer,
        thrice: integer,
        four_times: integer,
        five_times: integer,
        end: integer,
    ) -> integer:
        """The sum of (end - m)^b t, b up to 4, from t summed once to five times over; exact."""
        if b == 0:
            return once
        if b == 1:
            return end * once - twice
        # rising factorials m (m + 1) ... make powers of m with Stirling numbers of the second kind
        m_2 = integer(2) * thrice - twice
        if b == 2:
            return end * (end * once - integer(2) * twice) + m_2
        m_3 = integer(6) * (four_times - thrice) + twice
        if b == 3:
            return end * (end * (end * once - integer(3) * twice) + integer(3) * m_2) - m_3
        m_4 = integer(24) * five_times - integer(36) * four_times + integer(14) * thrice - twice
        inner = end * (end * once - integer(4) * twice) + integer(6) * m_2
        return end * (end * inner - integer(4) * m_3) + m_4

    return power_of_row


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


def running_order(exponents: tuple[tuple[int, int], ...]) -> tuple[tuple[int, int, int], ...]:
    """In which order the running sums of x^a y^b grow, a lower b before a higher one.

    Returns:
        Rows of the term, the term of x^a y^(b - 1) or -1 where b = 0, and a.
    """
    ordered = sorted(enumerate(exponents), key=lambda item: item[1][1])
    return tuple((term, exponents.index((a, b - 1)) if b else -1, a) for term, (a, b) in ordered)


def _sources(exponents: tuple[tuple[int, int], ...]) -> tuple[tuple[int, ...], ...]:
    """For every x^a y^b the terms of x^a, x^a y, ... x^a y^4 as far as b needs them, and b."""
    return tuple(
        (*(exponents.index((a, min(lower, b))) for lower in range(5)), b) for a, b in exponents
    )
