"""The mesh and the picture that changes of topology are measured on."""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.moments.moment_layout import MomentLayout, moment_types

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def ground_type(layout: MomentLayout) -> Any:
    """The struct that every kernel of a survey reads, for one layout of moments."""
    types = moment_types(layout)

    @wp.struct
    class Ground:
        """Arrays on the device; a half-edge is numbered as in `Mesh`."""

        half_edges: wp.array(dtype=int)
        """The changes to look at, by a half-edge each, [N]."""
        twins: wp.array(dtype=int)
        """The half-edge that runs the other way, -1 on the border, [3 T]."""
        corners: wp.array(dtype=int)
        """Vertex number of every half-edge's origin, [3 T]."""
        vertices: wp.array(dtype=wp.vec2d)
        """Positions [px], [V]."""
        energies: wp.array(dtype=wp.float64)
        """E(T) as it stands [code value^2 px], [T]."""
        sides: wp.array(dtype=wp.vec3i)
        """For each side of a triangle 2 * edge + (1 where the edge runs the other way), [T]."""
        color_sums: wp.array3d(dtype=types.integer)
        """Colour moments left of every edge as it stands, [E, 4 K, 1]."""
        area_sums: wp.array3d(dtype=types.integer)
        """Area moments left of every edge, [E, G, 1]."""
        table: wp.array(dtype=types.entry)
        """Prefix sums of the image, see `image_tables`."""
        gauge: wp.array(dtype=wp.vec3d)
        """The scale of energies and the size of the picture, see `fit`, [1]."""
        limits: wp.array(dtype=wp.float64)
        """Smallest height [px] and largest area [px^2] of the triangles that a change makes."""
        width: int
        """Columns of the image [px]."""
        height: int
        """Rows of the image [px]."""

    return Ground
