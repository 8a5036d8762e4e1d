"""The moments of everything left of one line, summed down the rows that it crosses."""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.moments.moment_layout import ENTRY, MomentLayout, moment_types
from warp_kernels.moments.prefix_tables import BLOCK_ROWS
from warp_kernels.moments.running_sums import area_adder, area_settler, color_adder, color_settler
from warp_kernels.raster import FRACTION_BITS, column_of, walk_edge

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

Total = wp.types.vector(length=ENTRY + 1, dtype=wp.int64)
"""The sums of colours and of squares, and the number of pixels."""

_SUM_ROWS = """
    typedef long long Sums __attribute__((vector_size(32)));
    typedef int Words __attribute__((vector_size(16), aligned(4)));
    const unsigned long long pitch = (width + 1ull) * (16 * BLOCK_ROWS);
    long long area = 0;
    wp::vec_t<5, wp::int64> total;
#if defined(__CUDA_ARCH__)
    long long sums[4] = {};
#else
    Sums sums = {};
#endif
    for (unsigned row = begin; row < (unsigned)end; ++row, position += step) {
        int column = (int)(position >> FRACTION_BITS);
        column = column < width ? column : width;
        column = column > 0 ? column : 0;
        const char* entry = (const char*)table + row / BLOCK_ROWS * pitch
            + row % BLOCK_ROWS * 16u + (unsigned)column * (16u * BLOCK_ROWS);
#if defined(__CUDA_ARCH__)
        for (int n = 0; n < 4; ++n) sums[n] += ((const int*)entry)[n];
#else
        // the next block lies too far away for the processor to guess
        __builtin_prefetch(entry + pitch);
        sums += __builtin_convertvector(*(const Words*)entry, Sums);
#endif
        area += column;
    }
    for (int n = 0; n < 4; ++n) total[n] = sign * sums[n];
    total[4] = sign * area;
    return total;
"""
_CONSTANTS = f"constexpr int BLOCK_ROWS = {BLOCK_ROWS}, FRACTION_BITS = {FRACTION_BITS};"


@wp.func_native(_CONSTANTS + _SUM_ROWS)
def sum_rows(
    position: wp.int64,
    step: wp.int64,
    begin: int,
    end: int,
    sign: int,
    table: wp.uint64,
    width: int,
) -> Total:
    """The sums of the walk of an `EdgeWalk`: of one colour, in the narrow layout."""
    ...


@cache
def line_moments(layout: MomentLayout) -> tuple[Any, Any]:
    """A wp.struct, the sums of everything left of a line, and a wp.func that finds them."""
    struct = _line_struct(layout)
    is_plain = layout.model.degree == 0 and not layout.wide
    return struct, _plain_walk(struct) if is_plain else _any_walk(layout, struct)


@cache
def _line_struct(layout: MomentLayout) -> Any:
    color_type, area_type = moment_types(layout).color, moment_types(layout).area

    @wp.struct
    class Line:
        """Sums of everything left of a line, negative where it runs upwards."""

        color: color_type
        area: area_type

    return Line


def _plain_walk(line_struct: Any) -> Any:
    """The walk of one colour in the narrow layout, which is by far the most usual."""

    @wp.func
    def left_of(
        a: wp.vec2i, b: wp.vec2i, table: wp.array(dtype=wp.vec4i), width: int, height: int
    ) -> line_struct:
        """Walk from a to b [1/256 px] over the table of a picture."""
        walk = walk_edge(a, b, height)
        total = sum_rows(
            walk.position, walk.step, walk.row_begin, walk.row_end, walk.sign, table.ptr, width
        )
        line = line_struct()
        for n in range(wp.static(ENTRY)):
            line.color[n] = total[n]
        line.area[0] = total[wp.static(ENTRY)]
        return line

    return left_of


def _any_walk(layout: MomentLayout, line_struct: Any) -> Any:
    """The walk of any colour in any layout."""
    types = moment_types(layout)
    color_type, area_type, integer, word = types.color, types.area, types.integer, types.word
    add_color, add_area = color_adder(layout), area_adder(layout)
    settle_color, settle_area = color_settler(layout), area_settler(layout)
    words = ENTRY * layout.depth
    row_bytes = layout.word_bytes * words

    @wp.func
    def left_of(
        a: wp.vec2i, b: wp.vec2i, table: wp.array(dtype=types.entry), width: int, height: int
    ) -> line_struct:
        """Walk from a to b [1/256 px] over the table of a picture."""
        walk = walk_edge(a, b, height)
        color = color_type()
        area = area_type()
        pitch = wp.uint64(width + 1) * wp.uint64(wp.static(BLOCK_ROWS * row_bytes))
        row = walk.row_begin
        while row < walk.row_end:
            block = row / wp.static(BLOCK_ROWS)
            inner = wp.uint64(row - block * wp.static(BLOCK_ROWS))
            address = table.ptr + wp.uint64(block) * pitch
            address += inner * wp.uint64(wp.static(row_bytes))
            # a plain array from the row on: its index is never negative and its stride is known
            length = wp.static(BLOCK_ROWS * words) * (width + 1)
            entries = wp.array(ptr=address, shape=(length,), dtype=word)
            column = wp.max(wp.min(column_of(walk.position), width), 0)
            color = add_color(color, entries, column)
            area = add_area(area, entries, column)
            walk.position += walk.step
            row += 1
        end = integer(walk.row_end - height / 2)
        line = line_struct()
        line.color = settle_color(color, end, integer(walk.sign), integer(width >> 31))
        line.area = settle_area(area, end, integer(width / 2), integer(walk.sign))
        return line

    return left_of
