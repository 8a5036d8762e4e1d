"""Integer moment sums along every edge and its displaced versions.

The moments of a triangle are a signed sum over its three edges of "everything left of the edge",
so their cost is the edge's height, not the triangle's area. Moving a corner changes two edges
only and both triangles beside an edge share its sums: nine walks per edge give all thirteen
variants of every triangle.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.color_model import ColorModel
from warp_kernels.device import Device, Phase
from warp_kernels.moments import area_sums_left_of, color_sums_left_of, moment_types
from warp_kernels.raster import SUBPIXELS, carry_of, to_fixed, walk_edge
from warp_kernels.variants import EDGE_VERSIONS, displacement

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def _edge_kernel(model: ColorModel, versions: int) -> Any:
    types = moment_types(model)
    color_type, area_type, powers_type = types.color, types.area, types.powers
    color_sums = color_sums_left_of(model)
    area_sums = area_sums_left_of(model)
    depth = model.table_depth

    @wp.kernel(enable_backward=False, module="unique")
    def sum_along_edges(
        begin: int,
        # In:
        vertices: wp.array(dtype=wp.vec2d),
        edges: wp.array(dtype=wp.vec2i),
        table: wp.array(dtype=wp.vec4i),
        powers: wp.array(dtype=powers_type),
        width: int,
        height: int,
        # Out:
        color_out: wp.array2d(dtype=color_type),
        area_out: wp.array2d(dtype=area_type),
    ):
        number = begin + wp.tid()
        edge = number / wp.static(versions)
        version = number - edge * wp.static(versions)
        a = to_fixed(vertices[edges[edge][0]])
        b = to_fixed(vertices[edges[edge][1]])
        if version >= 5:
            b = b + displacement(version - 5, wp.static(SUBPIXELS))
        elif version >= 1:
            a = a + displacement(version - 1, wp.static(SUBPIXELS))
        walk = walk_edge(a, b, height)
        column = walk.column
        remainder = walk.remainder
        color = color_type()
        area = area_type()
        for row in range(walk.row_begin, walk.row_end):
            clamped = wp.clamp(column, 0, width)
            entry = (row * (width + 1) + clamped) * wp.static(depth)
            y = wp.int64(row - height / 2)
            color += color_sums(table, entry, y)
            area += area_sums(powers[clamped], y)
            remainder += walk.remainder_step
            carry = carry_of(remainder, walk.denominator)
            remainder -= carry * walk.denominator
            column += walk.column_step + carry
        color_out[edge, version] = wp.int64(walk.sign) * color
        area_out[edge, version] = wp.int64(walk.sign) * area

    return sum_along_edges


def record_edge_moments(
    device: Device,
    model: ColorModel,
    *,
    vertices: wp.array,
    edges: wp.array,
    table: wp.array,
    powers: wp.array,
    size: tuple[int, int],
    color_out: wp.array,
    area_out: wp.array,
    versions: int = EDGE_VERSIONS,
) -> Phase:
    """Prepare the launch that sums the image's moments left of every edge and its versions.

    Integer sums: the result does not depend on device, thread count or order.

    Args:
        device: Where to run.
        model: Fixes the moments.
        vertices: Positions [px], [V] vec2d.
        edges: Vertex numbers of both ends, [E] vec2i.
        table: Prefix sums of the image, see `image_tables`.
        powers: Sums of x^a left of each column, [W + 1] vectors.
        size: Width and height of the image [px].
        color_out: Colour moments, [E, versions] vectors of 4 K int64.
        area_out: Area moments, [E, versions] vectors of G int64.
        versions: 9 for the gradient, 1 for the edge itself alone.

    Source: Lawonn & Guenther (2018), Sec. 4.1-4.2, Eqs. 11, 13-15.
    Deviation: sums run along edges of prefix tables instead of over fragments; the integers are
        the same.
    """
    inputs = [vertices, edges, table, powers, size[0], size[1]]
    kernel = _edge_kernel(model, versions)
    return device.record(kernel, inputs, [color_out, area_out], per_element=versions)
