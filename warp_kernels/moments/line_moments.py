"""The moments of everything left of one line, summed down the rows that it crosses."""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.moments.moment_layout import ENTRY, MomentLayout, moment_types
from warp_kernels.moments.prefix_tables import BLOCK_ROWS
from warp_kernels.moments.running_sums import area_adder, area_settler, color_adder, color_settler
from warp_kernels.raster import column_of, walk_edge

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def line_moments(layout: MomentLayout) -> tuple[Any, Any]:
    """A wp.struct, the sums of everything left of a line, and a wp.func that finds them."""
    types = moment_types(layout)
    color_type, area_type, integer, word = types.color, types.area, types.integer, types.word
    add_color, add_area = color_adder(layout), area_adder(layout)
    settle_color, settle_area = color_settler(layout), area_settler(layout)
    words = ENTRY * layout.depth
    row_bytes = layout.word_bytes * words

    @wp.struct
    class Line:
        """Sums of everything left of a line, negative where it runs upwards."""

        color: color_type
        area: area_type

    @wp.func
    def left_of(
        a: wp.vec2i, b: wp.vec2i, table: wp.array(dtype=types.entry), width: int, height: int
    ) -> Line:
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
        line = Line()
        line.color = settle_color(color, end, integer(walk.sign), integer(width >> 31))
        line.area = settle_area(area, end, integer(width / 2), integer(walk.sign))
        return line

    return Line, left_of
