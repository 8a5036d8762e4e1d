"""The paper's own way to sum: every fragment of every variant adds to its variant's moments.

Kept as the reference that `edge_moments` must equal to the bit, and as the measure of its gain.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.moments.moment_layout import MomentLayout, moment_types
from warp_kernels.moments.pixel_moments import area_sums_of_pixel, color_sums_of_pixel
from warp_kernels.moments.variants import TRIANGLE_VARIANTS, displacement
from warp_kernels.raster import first_row_below, to_fixed, winding

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def fragment_kernel(layout: MomentLayout) -> Any:
    """The kernel that adds up the fragments of one variant of a triangle."""
    types = moment_types(layout)
    color_type, area_type, integer = types.color, types.area, types.integer
    color_sums = color_sums_of_pixel(layout)
    area_sums = area_sums_of_pixel(layout)
    wide = layout.wide

    @wp.kernel(module="unique", module_options=EXACT)
    def sum_fragments(
        span: wp.array(dtype=wp.vec2i),
        # In:
        vertices: wp.array(dtype=wp.vec2d),
        triangles: wp.array(dtype=wp.vec3i),
        probe: wp.array(dtype=int),
        pixels: wp.array2d(dtype=wp.vec3ub),
        weights: wp.array2d(dtype=wp.uint8),
        # Out:
        color_out: wp.array2d(dtype=color_type),
        area_out: wp.array2d(dtype=area_type),
    ):
        """Add up the fragments of one variant of one triangle."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        triangle = number / wp.static(TRIANGLE_VARIANTS)
        variant = number - triangle * wp.static(TRIANGLE_VARIANTS)
        corners = triangles[triangle]
        height = pixels.shape[0]
        width = pixels.shape[1]
        a = to_fixed(vertices[corners[0]])
        b = to_fixed(vertices[corners[1]])
        c = to_fixed(vertices[corners[2]])
        if variant > 0:
            step = displacement((variant - 1) & 3, probe[0])
            if variant <= 4:
                a = a + step
            elif variant <= 8:
                b = b + step
            else:
                c = c + step
        left = wp.max(first_row_below(wp.min(wp.min(a[0], b[0]), c[0])), 0)
        right = wp.min(first_row_below(wp.max(wp.max(a[0], b[0]), c[0])), width)
        top = wp.max(first_row_below(wp.min(wp.min(a[1], b[1]), c[1])), 0)
        bottom = wp.min(first_row_below(wp.max(wp.max(a[1], b[1]), c[1])), height)
        color_out[triangle, variant] = color_type()
        area_out[triangle, variant] = area_type()
        for row in range(top, bottom):
            y = integer(row - height / 2)
            for column in range(left, right):
                inside = (
                    winding(a, b, column, row)
                    + winding(b, c, column, row)
                    + winding(c, a, column, row)
                )
                if inside != 0:
                    x = integer(column - width / 2)
                    weight = integer(inside)
                    if wp.static(wide):
                        weight *= integer(weights[row, column])
                    color = color_sums(pixels[row, column], weight, x, y)
                    area = area_sums(weight, x, y)
                    wp.atomic_add(color_out, triangle, variant, color)
                    wp.atomic_add(area_out, triangle, variant, area)

    return sum_fragments


def record_fragment_moments(
    device: Device,
    layout: MomentLayout,
    *,
    vertices: wp.array,
    triangles: wp.array,
    probe: wp.array,
    pixels: wp.array,
    weights: wp.array,
    color_out: wp.array,
    area_out: wp.array,
) -> Phase:
    """Prepare the launch that rasterises every variant and adds up its fragments.

    It reads the picture itself, not its prefix table, and asks of every pixel of a variant's
    bounding box whether it lies inside. A variant turned inside out counts negatively.

    Args:
        device: Where to run.
        layout: Fixes the moments and their integers.
        vertices: Positions [px], [V] vec2d.
        triangles: Corners, [T] vec3i.
        probe: How far corners are displaced [1/256 px], [1].
        pixels: Code values, [H, W] vec3ub.
        weights: Weight of every pixel, [H, W] uint8. Not read in the narrow layout.
        color_out: Colour moments, [T, 13] vectors of 4 K integers.
        area_out: Area moments, [T, 13] vectors of G integers.

    Source: Lawonn & Guenther (2018), Sec. 4.2.
    Deviation: the error follows from the moments, without a second pass over the fragments.
    """
    inputs = [vertices, triangles, probe, pixels, weights]
    kernel = fragment_kernel(layout)
    return device.record(kernel, inputs, [color_out, area_out], per_element=TRIANGLE_VARIANTS)
