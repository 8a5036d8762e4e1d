"""The error of a triangle that is not in the mesh: what a change of topology would leave.

Triangles around a new vertex share the lines that lead to it, and the sums along a line are those
of the way back with the other sign: every line is walked once.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.energy.fit import fit_moments
from warp_kernels.energy.topology_inputs import ground_type
from warp_kernels.moments.line_moments import line_moments
from warp_kernels.moments.moment_layout import MomentLayout, moment_types
from warp_kernels.moments.triangle_sides import side_sums
from warp_kernels.raster import to_fixed

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def line_sums(layout: MomentLayout) -> tuple[Any, Any, Any]:
    """What lies left of lines, and the energy of triangles between them: three wp.funcs.

    Returns:
        `along` gives the sums along a line between two points [px] from the picture's tables;
        `known` those along a half-edge of the mesh, which `fit` has summed already; `energy`
        takes those of a triangle's three sides, each with the sign 1, or -1 where the line runs
        the other way.
    """
    ground_struct = ground_type(layout)
    integer = moment_types(layout).integer
    line_struct, left_of = line_moments(layout)
    fit = fit_moments(layout)
    side_color, side_area = side_sums(layout)

    @wp.func
    def along(tail: wp.vec2d, head: wp.vec2d, ground: ground_struct) -> line_struct:
        """Walk down the rows that a line crosses."""
        return left_of(to_fixed(tail), to_fixed(head), ground.table, ground.width, ground.height)

    @wp.func
    def known(half_edge: int, ground: ground_struct) -> line_struct:
        """Read the sums of an edge of the mesh, seen from one of its half-edges."""
        side = ground.sides[half_edge / 3][half_edge % 3]
        line = line_struct()
        line.color = side_color(ground.color_sums, side, 0)
        line.area = side_area(ground.area_sums, side, 0)
        return line

    @wp.func
    def energy(
        ab: line_struct,
        ab_sign: int,
        bc: line_struct,
        bc_sign: int,
        ca: line_struct,
        ca_sign: int,
        ground: ground_struct,
    ) -> wp.float64:
        """Add the three sides, then solve."""
        color = integer(ab_sign) * ab.color + integer(bc_sign) * bc.color
        area = integer(ab_sign) * ab.area + integer(bc_sign) * bc.area
        color += integer(ca_sign) * ca.color
        area += integer(ca_sign) * ca.area
        return fit(color, area, ground.gauge[0]).energy

    return along, known, energy
