"""How much of every output pixel the drawn edges cover: analytic, so smooth at any width."""

import warp as wp

from warp_kernels.device import Device, Phase
from warp_kernels.raster import SUBPIXELS, to_fixed

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

BAND = 32
"""Rows of one band [px]: bands are what threads share out, so no two write one pixel."""
_BAND = wp.constant(BAND)
_UNIT = wp.constant(SUBPIXELS)
_PER_UNIT = wp.constant(1.0 / SUBPIXELS)


@wp.func
def distance_to_segment(p: wp.vec2f, a: wp.vec2f, b: wp.vec2f) -> float:
    """Distance from a point to a line segment [px]."""
    along = b - a
    t = wp.dot(p - a, along) / wp.max(wp.dot(along, along), 1.0e-12)
    return wp.length(p - a - wp.clamp(t, 0.0, 1.0) * along)


@wp.func
def line_coverage(distance: float, half_width: float) -> float:
    """Part of a pixel within `half_width` of a line through it at `distance` [px]."""
    outer = wp.clamp(half_width - distance + 0.5, 0.0, 1.0)
    inner = wp.clamp(-half_width - distance + 0.5, 0.0, 1.0)
    return outer - inner


@wp.kernel(enable_backward=False)
def cover_edges(
    span: wp.array(dtype=wp.vec2i),
    # In:
    vertices: wp.array(dtype=wp.vec2d),
    edges: wp.array(dtype=wp.vec2i),
    edge_count: wp.array(dtype=int),
    scale: wp.vec2d,
    half_width: float,
    # Out:
    coverage_out: wp.array2d(dtype=float),
):
    """Draw one edge into one band of rows."""
    number = span[0][0] + wp.tid()
    if number >= span[0][1]:
        return
    band = number / edge_count[0]
    edge = edges[number - band * edge_count[0]]
    first = to_fixed(wp.cw_mul(vertices[edge[0]], scale))
    second = to_fixed(wp.cw_mul(vertices[edge[1]], scale))
    # seen from the pixel in which it begins, a line is the same wherever it lies
    left = first[0] >> 8
    top = first[1] >> 8
    a = wp.vec2f(float(first[0] - left * _UNIT), float(first[1] - top * _UNIT)) * _PER_UNIT
    b = wp.vec2f(float(second[0] - left * _UNIT), float(second[1] - top * _UNIT)) * _PER_UNIT
    reach = half_width + 0.5
    row = wp.max(int(wp.floor(wp.min(a[1], b[1]) - reach)), band * _BAND - top)
    last_row = wp.min(int(wp.ceil(wp.max(a[1], b[1]) + reach)), (band + 1) * _BAND - top)
    last_row = wp.min(last_row, coverage_out.shape[0] - top)
    rise = b[1] - a[1]
    while row < last_row:
        y = float(row) + 0.5
        t0 = float(0.0)
        t1 = float(1.0)
        if wp.abs(rise) > 1.0e-3:
            t0 = wp.clamp((y - reach - a[1]) / rise, 0.0, 1.0)
            t1 = wp.clamp((y + reach - a[1]) / rise, 0.0, 1.0)
        x0 = a[0] + t0 * (b[0] - a[0])
        x1 = a[0] + t1 * (b[0] - a[0])
        column = wp.max(int(wp.floor(wp.min(x0, x1) - reach)), -left)
        last = wp.min(int(wp.ceil(wp.max(x0, x1) + reach)), coverage_out.shape[1] - left)
        while column < last:
            distance = distance_to_segment(wp.vec2f(float(column) + 0.5, y), a, b)
            covered = line_coverage(distance, half_width)
            if covered > 0.0:
                wp.atomic_max(coverage_out, top + row, left + column, covered)
            column += 1
        row += 1


def record_edge_coverage(
    device: Device,
    *,
    vertices: wp.array,
    edges: wp.array,
    edge_count: wp.array,
    scale: tuple[float, float],
    half_width: float,
    coverage_out: wp.array,
) -> Phase:
    """Prepare the launch that draws all edges into a coverage buffer.

    The phase counts bands of rows; each has as many threads as there are edges.

    Args:
        device: Where to run.
        vertices: Positions [px of the picture], [V] vec2d.
        edges: Ends, [E] vec2i.
        edge_count: E, [1] int32.
        scale: Output pixels per pixel of the picture, across and down.
        half_width: Half the width of a line [output px].
        coverage_out: Covered part of every output pixel, [rows, columns] float32, zero before.
    """
    inputs = [vertices, edges, edge_count, wp.vec2d(*scale), half_width]
    return device.record(cover_edges, inputs, [coverage_out])
