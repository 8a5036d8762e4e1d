"""Integer moment sums along every edge and its displaced versions.

The moments of a triangle are a signed sum over its three edges of "everything left of the edge",
so their cost is the edge's height, not the triangle's area. Moving a corner changes two edges
only and both triangles beside an edge share its sums: nine walks per edge give all thirteen
variants of every triangle.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device import Device, Phase
from warp_kernels.image_tables import BLOCK_ROWS
from warp_kernels.moment_layout import ENTRY, MomentLayout, moment_types
from warp_kernels.raster import column_of, to_fixed, walk_edge
from warp_kernels.running_sums import area_adder, area_settler, color_adder, color_settler
from warp_kernels.variants import EDGE_VERSIONS, end_displacement

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

EDGE_OPTIONS = {
    "enable_backward": False,
    "fuse_fp": False,
    "cpu_compiler_flags": "-march=native -mprefer-vector-width=512 -fno-vectorize"
    " -mllvm=-inline-threshold=9000 -mllvm=-inline-cold-callsite-threshold=3000"
    " -mllvm=-slp-recursion-max-depth=12",
}
"""LLVM is to put several versions of an edge into one register, not several rows of one version,
which it would have to gather from all over the table; for that it must look deeper than Warp lets
it, and use the widest registers that there are (linear colours take a third less time). The other
flags are Warp's own."""


@cache
def _walk_starter(lanes: int) -> Any:
    """A wp.func: start the walks of `lanes` versions of an edge in one common row."""
    int_lanes = wp.types.vector(length=lanes, dtype=wp.int32)
    long_lanes = wp.types.vector(length=lanes, dtype=wp.int64)

    @wp.func
    def start_walks(a: wp.vec2i, b: wp.vec2i, probe: int, first: int, height: int):
        """Versions from `first` on: per version `EdgeWalk`, then the first and the end row."""
        position = long_lanes()
        step = long_lanes()
        row_begin = int_lanes()
        row_count = int_lanes()
        sign = int_lanes()
        row = height
        end = int(0)
        for i in range(wp.static(lanes)):
            start_move = end_displacement(first + i, 0, probe)
            end_move = end_displacement(first + i, 1, probe)
            walk = walk_edge(a + start_move, b + end_move, height)
            position[i] = walk.position
            step[i] = walk.step
            row_begin[i] = walk.row_begin
            row_count[i] = walk.row_end - walk.row_begin
            sign[i] = walk.sign
            row = wp.min(row, walk.row_begin)
            end = wp.max(end, walk.row_end)
        for i in range(wp.static(lanes)):
            position[i] -= wp.int64(row_begin[i] - row) * step[i]
        return position, step, row_begin, row_count, sign, row, end

    return start_walks


@cache
def _edge_kernel(layout: MomentLayout, versions: int, lanes: int) -> Any:
    """The kernel of which every thread walks `lanes` of an edge's versions side by side."""
    types, model = moment_types(layout), layout.model
    color_type, area_type, integer, word = types.color, types.area, types.integer, types.word
    add_color, add_area = color_adder(layout), area_adder(layout)
    settle_color, settle_area = color_settler(layout), area_settler(layout)
    start_walks = _walk_starter(lanes)
    parts = versions // lanes
    words = ENTRY * layout.depth
    row_bytes = layout.word_bytes * words
    color_lanes = wp.types.matrix(shape=(lanes, 4 * model.term_count), dtype=integer)
    area_lanes = wp.types.matrix(shape=(lanes, model.area_count), dtype=integer)

    @wp.kernel(module="unique", module_options=EDGE_OPTIONS)
    def sum_along_edges(
        span: wp.array(dtype=wp.vec2i),
        # In:
        vertices: wp.array(dtype=wp.vec2d),
        edges: wp.array(dtype=wp.vec2i),
        moved: wp.array(dtype=int),
        probe: wp.array(dtype=int),
        table: wp.array(dtype=types.entry),
        width: int,
        height: int,
        # Out:
        color_out: wp.array2d(dtype=color_type),
        area_out: wp.array2d(dtype=area_type),
    ):
        """Walk down all rows that any of the versions crosses."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        edge = number / wp.static(parts)
        first = (number - edge * wp.static(parts)) * wp.static(lanes)
        ends = edges[edge]
        if wp.static(versions > 1) and moved[ends[0]] + moved[ends[1]] == 0:
            return  # the sums of an edge at rest still stand
        a = to_fixed(vertices[ends[0]])
        b = to_fixed(vertices[ends[1]])
        position, step, row_begin, row_count, sign, row, end = start_walks(
            a, b, probe[0], first, height
        )
        color = color_lanes()
        area = area_lanes()
        pitch = wp.uint64(width + 1) * wp.uint64(wp.static(BLOCK_ROWS * row_bytes))
        while row < end:
            block = row / wp.static(BLOCK_ROWS)
            inner = wp.uint64(row - block * wp.static(BLOCK_ROWS))
            address = table.ptr + wp.uint64(block) * pitch
            address += inner * wp.uint64(wp.static(row_bytes))
            # a plain array from the row on: its index is never negative and its stride is known
            length = wp.static(BLOCK_ROWS * words) * (width + 1)
            line = wp.array(ptr=address, shape=(length,), dtype=word)
            for i in range(wp.static(lanes)):
                column = wp.max(wp.min(column_of(position[i]), width), 0)
                # where a version does not cross the row it reads column 0: nothing lies left of it
                inside = wp.uint32(row - row_begin[i]) < wp.uint32(row_count[i])
                column = wp.where(inside, column, 0)
                color[i] = add_color(color[i], line, column)
                area[i] = add_area(area[i], line, column)
            position += step
            row += 1
        last = integer(end - height / 2)
        middle = integer(width / 2)
        nothing = integer(width >> 31)
        for i in range(wp.static(lanes)):
            color_out[edge, first + i] = settle_color(color[i], last, integer(sign[i]), nothing)
            area_out[edge, first + i] = settle_area(area[i], last, middle, integer(sign[i]))

    return sum_along_edges


def record_edge_moments(
    device: Device,
    layout: MomentLayout,
    *,
    vertices: wp.array,
    edges: wp.array,
    moved: wp.array,
    probe: wp.array,
    table: wp.array,
    size: tuple[int, int],
    color_out: wp.array,
    area_out: wp.array,
    versions: int = EDGE_VERSIONS,
) -> Phase:
    """Prepare the launch that sums the image's moments left of every edge and its versions.

    Integer sums: the result does not depend on device, thread count or order.

    Args:
        device: Where to run.
        layout: Fixes the moments and their integers.
        vertices: Positions [px], [V] vec2d.
        edges: Vertex numbers of both ends, [E] vec2i.
        moved: 1 where a vertex has moved since the sums were taken, [V]; the nine versions of an
            edge at rest are left as they are.
        probe: How far ends are displaced [1/256 px], [1].
        table: Prefix sums of the image, see `image_tables`.
        size: Width and height of the image [px].
        color_out: Colour moments, [E, versions] vectors of 4 K integers.
        area_out: Area moments, [E, versions] vectors of G integers.
        versions: 9 for the gradient, 1 for the edge itself alone.

    Source: Lawonn & Guenther (2018), Sec. 4.1-4.2, Eqs. 11, 13-15.
    Deviation: sums run along edges of prefix tables instead of over fragments; the integers are
        the same.
    """
    inputs = [vertices, edges, moved, probe, table, size[0], size[1]]
    # versions share vector registers on a CPU, unless the sums of one fill them all; on CUDA more
    # threads are worth more
    lanes = 1 if device.is_cuda or layout.wide else versions
    kernel = _edge_kernel(layout, versions, lanes)
    return device.record(kernel, inputs, [color_out, area_out], per_element=versions // lanes)
