"""Which triangle lies under every sample of a band of the output.

A whole output has nine samples a pixel, more than the caches hold; a band fits.

Coverage is that of `raster`: each sample belongs to exactly one triangle, so neither a gap nor a
doubled border can show, and no order of threads matters.
"""

import warp as wp

from warp_kernels.device import Device, Phase
from warp_kernels.raster import SUBPIXELS, column_of, to_fixed, walk_edge

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

_UNIT = wp.constant(SUBPIXELS)


@wp.kernel(enable_backward=False)
def fill_triangles(
    span: wp.array(dtype=wp.vec2i),
    # In:
    vertices: wp.array(dtype=wp.vec2d),
    triangles: wp.array(dtype=wp.vec3i),
    scale: wp.vec2d,
    first_row: int,
    # Out:
    triangle_out: wp.array2d(dtype=int),
):
    """Fill the rows of one triangle, between its long edge and the two short ones."""
    triangle = span[0][0] + wp.tid()
    if triangle >= span[0][1]:
        return
    width = triangle_out.shape[1]
    height = triangle_out.shape[0] - 1
    corners = triangles[triangle]
    above = wp.vec2i(0, first_row * _UNIT)
    top = to_fixed(wp.cw_mul(vertices[corners[0]], scale)) - above
    middle = to_fixed(wp.cw_mul(vertices[corners[1]], scale)) - above
    bottom = to_fixed(wp.cw_mul(vertices[corners[2]], scale)) - above
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
    pitch = wp.uint64(width) * wp.uint64(4)
    address = triangle_out.ptr + wp.uint64(row) * pitch
    while row < long.row_end:
        # a plain array of one row: no sign check of the index, so the compiler fills in blocks
        line = wp.array(ptr=address, shape=(width,), dtype=int)
        if row >= short.row_end:
            short = walk_edge(middle, bottom, height)
        long_column = column_of(long.position)
        short_column = column_of(short.position)
        column = wp.max(wp.min(long_column, short_column), 0)
        last = wp.min(wp.max(long_column, short_column), width)
        while column < last:
            line[column] = triangle
            column += 1
        long.position += long.step
        short.position += short.step
        address += pitch
        row += 1


def record_gbuffer(
    device: Device,
    *,
    vertices: wp.array,
    triangles: wp.array,
    scale: tuple[float, float],
    first_row: int,
    triangle_out: wp.array,
) -> Phase:
    """Prepare the launch that writes every sample's triangle.

    Args:
        device: Where to run.
        vertices: Positions [px of the picture], [V] vec2d.
        triangles: Corners, [T] vec3i.
        scale: Samples per pixel of the picture, across and down.
        first_row: The sample row of the output with which `triangle_out` begins.
        triangle_out: Triangle of each sample of a band of the output, [rows, columns] int32;
            across it is the output's width times the samples per output pixel.
    """
    inputs = [vertices, triangles, wp.vec2d(*scale), first_row]
    return device.record(fill_triangles, inputs, [triangle_out])
