"""The error of a triangle that is not in the mesh: what a change of topology would leave."""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.fit import fit_moments
from warp_kernels.image_tables import table_entry
from warp_kernels.moment_layout import MomentLayout, moment_types
from warp_kernels.moments import area_sums_left_of, color_sums_left_of
from warp_kernels.raster import column_of, to_fixed, walk_edge

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def triangle_energy(layout: MomentLayout) -> Any:
    """A wp.func: E of the triangle a, b, c [px] from nine numbers and the picture's tables."""
    types = moment_types(layout)
    color_type, area_type, integer = types.color, types.area, types.integer
    color_sums = color_sums_left_of(layout)
    area_sums = area_sums_left_of(layout)
    depth = layout.depth
    fit = fit_moments(layout)

    @wp.func
    def energy(
        a: wp.vec2d,
        b: wp.vec2d,
        c: wp.vec2d,
        table: wp.array(dtype=types.entry),
        powers: wp.array(dtype=types.powers),
        gauge: wp.vec3d,
        height: int,
    ) -> wp.float64:
        """Sum along the three edges, then solve."""
        width = powers.shape[0] - 1
        color = color_type()
        area = area_type()
        for side in range(3):
            tail = a
            head = b
            if side == 1:
                tail = b
                head = c
            if side == 2:
                tail = c
                head = a
            walk = walk_edge(to_fixed(tail), to_fixed(head), height)
            sign = integer(walk.sign)
            row = walk.row_begin
            while row < walk.row_end:
                column = wp.clamp(column_of(walk.position), 0, width)
                y = wp.int64(row - height / 2)
                entry = table_entry(row, column, width, wp.static(depth))
                color += sign * color_sums(table, entry, y)
                area += sign * area_sums(table, entry, powers[column], y)
                walk.position += walk.step
                row += 1
        return fit(color, area, gauge).energy

    return energy
