"""Which triangle lies under every sample of the output.

Coverage is that of `raster`: each sample belongs to exactly one triangle, so neither a gap nor a
doubled border can show, and no order of threads matters.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device import Device, Phase
from warp_kernels.raster import carry_of, to_fixed, walk_edge

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def _gbuffer_kernel() -> Any:
    @wp.kernel(enable_backward=False, module="unique")
    def fill_triangles(
        begin: int,
        # In:
        vertices: wp.array(dtype=wp.vec2d),
        triangles: wp.array(dtype=wp.vec3i),
        scale: wp.vec2d,
        # Out:
        triangle_out: wp.array2d(dtype=int),
    ):
        """Fill the rows of one triangle, between its long edge and the two short ones."""
        triangle = begin + wp.tid()
        width = triangle_out.shape[1]
        height = triangle_out.shape[0]
        corners = triangles[triangle]
        top = to_fixed(wp.cw_mul(vertices[corners[0]], scale))
        middle = to_fixed(wp.cw_mul(vertices[corners[1]], scale))
        bottom = to_fixed(wp.cw_mul(vertices[corners[2]], scale))
        if middle[1] < top[1]:
            swap = top
            top = middle
            middle = swap
        if bottom[1] < top[1]:
            swap = top
            top = bottom
            bottom = swap
        if bottom[1] < middle[1]:
            swap = middle
            middle = bottom
            bottom = swap
        long = walk_edge(top, bottom, height)
        short = walk_edge(top, middle, height)
        row = long.row_begin
        while row < long.row_end:
            if row >= short.row_end:
                short = walk_edge(middle, bottom, height)
            column = wp.max(wp.min(long.column, short.column), 0)
            last = wp.min(wp.max(long.column, short.column), width)
            while column < last:
                triangle_out[row, column] = triangle
                column += 1
            long.remainder += long.remainder_step
            carry = carry_of(long.remainder, long.denominator)
            long.remainder -= carry * long.denominator
            long.column += long.column_step + carry
            short.remainder += short.remainder_step
            carry = carry_of(short.remainder, short.denominator)
            short.remainder -= carry * short.denominator
            short.column += short.column_step + carry
            row += 1

    return fill_triangles


def record_gbuffer(
    device: Device,
    *,
    vertices: wp.array,
    triangles: wp.array,
    scale: tuple[float, float],
    triangle_out: wp.array,
) -> Phase:
    """Prepare the launch that writes every sample's triangle.

    Args:
        device: Where to run.
        vertices: Positions [px of the picture], [V] vec2d.
        triangles: Corners, [T] vec3i.
        scale: Samples per pixel of the picture, across and down.
        triangle_out: Triangle of each sample, [rows, columns] int32; its size is that of the
            output times the samples per output pixel.
    """
    inputs = [vertices, triangles, wp.vec2d(*scale)]
    return device.record(_gbuffer_kernel(), inputs, [triangle_out])
