"""Which part of every triangle is seen: its own smaller copies, as a picture of two masks."""

import warp as wp

from warp_kernels.scene.scene import (
    Ink,
    Sample,
    Scene,
    StyleParameters,
    color_of,
    depth_inside,
    full_ink,
)
from warp_kernels.scene.triangle_frame import coverage_of, inradius

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def part_within(depth: float, radius: float, size: float, extent: float) -> float:
    """Part of a point that lies in a copy of its triangle about the incentre.

    Args:
        depth: Distance of the point from the nearest side [px].
        radius: The inradius [px].
        size: Of the copy, 0 to 1; at 1 there is no seam, and at 0 nothing.
        extent: Side of the square that the point stands for [px].
    """
    return coverage_of(depth - (1.0 - size) * radius + (size - 0.5) * extent, extent)


@wp.func
def veil_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """Red for the copy of the one size, green for that of the other."""
    t = sample.triangle
    sizes = color_of(scene, t) / 255.0
    depth = depth_inside(scene.lines[t], sample.offset)
    radius = inradius(scene, sample)
    red = part_within(depth, radius, sizes[0], sample.extent)
    green = part_within(depth, radius, sizes[1], sample.extent)
    return full_ink(wp.vec3f(255.0 * red, 255.0 * green, 0.0))
