"""The three sides of a triangle, and the sums that each adds to the triangle's moments."""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.moments.moment_layout import MomentLayout, moment_types

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def side_sums(layout: MomentLayout) -> tuple[Any, Any]:
    """Two wp.funcs: what a version of an edge adds to the sums of a triangle beside it."""
    types, model = moment_types(layout), layout.model
    color_type, area_type, integer = types.color, types.area, types.integer

    # (n ^ -1) + 1 is -n: a product of 64-bit integers would cost several times more
    @wp.func
    def signed_moment(sums: wp.array3d(dtype=integer), side: int, n: int, version: int) -> integer:
        """One moment of an edge with the sign of the side."""
        versions = sums.shape[2]
        first = wp.uint64(((side >> 1) * sums.shape[1] + n) * versions)
        # a plain array: its stride is known, so versions that follow each other are read at once
        moment = wp.array(ptr=sums.ptr + first * wp.uint64(8), shape=(versions,), dtype=integer)
        reversed_edge = integer(side & 1)
        return (moment[version] ^ -reversed_edge) + reversed_edge

    @wp.func
    def side_color(sums: wp.array3d(dtype=integer), side: int, version: int) -> color_type:
        """Colour moments with the sign of the side."""
        color = color_type()
        for n in range(wp.static(4 * model.term_count)):
            color[n] = signed_moment(sums, side, n, version)
        return color

    @wp.func
    def side_area(sums: wp.array3d(dtype=integer), side: int, version: int) -> area_type:
        """Area moments with the sign of the side."""
        area = area_type()
        for n in range(wp.static(model.area_count)):
            area[n] = signed_moment(sums, side, n, version)
        return area

    return side_color, side_area
