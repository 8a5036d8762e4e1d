"""Integer moment sums along every edge and its displaced versions.

The moments of a triangle are a signed sum over its three edges of "everything left of the edge",
so their cost is the edge's height, not the triangle's area. Moving a corner changes two edges
only and both triangles beside an edge share its sums: nine walks per edge give all thirteen
variants of every triangle.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.moments.due import edge_is_due
from warp_kernels.moments.edge_walk import row_walker
from warp_kernels.moments.line_moments import line_moments
from warp_kernels.moments.moment_layout import MomentLayout, moment_types
from warp_kernels.moments.variants import EDGE_VERSIONS, end_displacement
from warp_kernels.raster import to_fixed, walk_edge

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def _walk_starter() -> Any:
    """A wp.func: start the walks of all versions of an edge in one common row."""
    ints = wp.types.vector(length=EDGE_VERSIONS, dtype=wp.int32)
    longs = wp.types.vector(length=EDGE_VERSIONS, dtype=wp.int64)

    @wp.func
    def start_walks(a: wp.vec2i, b: wp.vec2i, probe: int, height: int):
        """Per version what `EdgeWalk` holds, then the first and the end row."""
        position = longs()
        step = longs()
        row_begin = ints()
        row_count = ints()
        sign = ints()
        row = height
        end = int(0)
        for i in range(wp.static(EDGE_VERSIONS)):
            start_move = end_displacement(i, 0, probe)
            end_move = end_displacement(i, 1, probe)
            walk = walk_edge(a + start_move, b + end_move, height)
            position[i] = walk.position
            step[i] = walk.step
            row_begin[i] = walk.row_begin
            row_count[i] = walk.row_end - walk.row_begin
            sign[i] = walk.sign
            row = wp.min(row, walk.row_begin)
            end = wp.max(end, walk.row_end)
        for i in range(wp.static(EDGE_VERSIONS)):
            position[i] -= wp.int64(row_begin[i] - row) * step[i]
        return position, step, row_begin, row_count, sign, row, end

    return start_walks


@cache
def _side_by_side_kernel(layout: MomentLayout) -> Any:
    """The kernel of which every thread walks all versions of an edge, in the narrow layout."""
    types = moment_types(layout)
    start_walks, walk_rows = _walk_starter(), row_walker(layout)

    @wp.kernel(module="unique", module_options=EXACT)
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
        color_out: wp.array3d(dtype=types.integer),
        area_out: wp.array3d(dtype=types.integer),
    ):
        """Walk down all rows that any of the versions crosses."""
        edge = span[0][0] + wp.tid()
        if edge >= span[0][1]:
            return
        ends = edges[edge]
        if not edge_is_due(moved, ends):
            return  # the sums of an edge at rest still stand
        position, step, row_begin, row_count, sign, row, end = start_walks(
            to_fixed(vertices[ends[0]]), to_fixed(vertices[ends[1]]), probe[0], height
        )
        walk_rows(
            position, step, row_begin, row_count, sign, row, end, table.ptr, width, height, edge,
            color_out, area_out,
        )  # fmt: skip

    return sum_along_edges


@cache
def _edge_kernel(layout: MomentLayout, versions: int) -> Any:
    """The kernel of which every thread walks one version of an edge."""
    types, model = moment_types(layout), layout.model
    _, left_of = line_moments(layout)

    @wp.kernel(module="unique", module_options=EXACT)
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
        color_out: wp.array3d(dtype=types.integer),
        area_out: wp.array3d(dtype=types.integer),
    ):
        """Walk down the rows that it crosses."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        edge = number / wp.static(versions)
        version = number - edge * wp.static(versions)
        ends = edges[edge]
        if wp.static(versions > 1) and not edge_is_due(moved, ends):
            return  # the sums of an edge at rest still stand
        a = to_fixed(vertices[ends[0]]) + end_displacement(version, 0, probe[0])
        b = to_fixed(vertices[ends[1]]) + end_displacement(version, 1, probe[0])
        line = left_of(a, b, table, width, height)
        for n in range(wp.static(4 * model.term_count)):
            color_out[edge, n, version] = line.color[n]
        for n in range(wp.static(model.area_count)):
            area_out[edge, n, version] = line.area[n]

    return sum_along_edges


def edge_kernel(device: Device, layout: MomentLayout, versions: int) -> tuple[Any, int]:
    """The kernel that walks along edges, and how many of its threads share an edge.

    Args:
        device: Where to run.
        layout: Fixes the moments and their integers.
        versions: 9 for the gradient, 1 for the edge itself alone.
    """
    # versions share vector registers on a CPU, unless the sums of one fill them all; on CUDA more
    # threads are worth more
    if versions == EDGE_VERSIONS and not (device.is_cuda or layout.wide):
        return _side_by_side_kernel(layout), 1
    return _edge_kernel(layout, versions), versions


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
        moved: Marks of what has moved since the sums were taken, see `due`, [V]; the nine versions
            of an edge at rest are left as they are.
        probe: How far ends are displaced [1/256 px], [1].
        table: Prefix sums of the image, see `image_tables`.
        size: Width and height of the image [px].
        color_out: Colour moments, [E, 4 K, versions]: those of a moment lie side by side, so that
            a processor reads several versions at once.
        area_out: Area moments, [E, G, versions].
        versions: 9 for the gradient, 1 for the edge itself alone.

    Source: Lawonn & Guenther (2018), Sec. 4.1-4.2, Eqs. 11, 13-15.
    Deviation: sums run along edges of prefix tables instead of over fragments; the integers are
        the same.
    """
    inputs = [vertices, edges, moved, probe, table, size[0], size[1]]
    kernel, threads = edge_kernel(device, layout, versions)
    return device.record(kernel, inputs, [color_out, area_out], per_element=threads)
