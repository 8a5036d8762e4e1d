"""Every triangle drawn a little smaller, with gaps between them."""

import warp as wp

from warp_kernels.scene.scene import (
    Ink,
    Sample,
    Scene,
    StyleParameters,
    color_of,
    depth_inside,
    incentre_of,
    side_of,
)
from warp_kernels.scene.triangle_frame import (
    coverage_of,
    distance_to_segment,
    from_incentre,
    inradius,
)

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def outside_of(p: wp.vec2f, a: wp.vec2f, b: wp.vec2f, c: wp.vec2f) -> float:
    """Distance from the outline of a triangle [px]."""
    away = wp.min(distance_to_segment(p, a, b), distance_to_segment(p, b, c))
    return wp.min(away, distance_to_segment(p, c, a))


@wp.func
def shrunk_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The triangle's mean colour inside a smaller triangle with round corners."""
    t = sample.triangle
    radius = inradius(scene, sample)
    left = wp.max(radius - 0.5 * parameters.numbers[0], parameters.numbers[1] * radius)
    rounding = parameters.numbers[2] * left
    core = left - rounding
    # the core is the triangle without all that is nearer to a side than its inradius allows
    depth = depth_inside(scene.lines[t], sample.offset) - (radius - core)
    if depth < 0.0:
        size = core / radius
        centre = incentre_of(scene, t)
        first = size * (side_of(scene, t, 0) - centre)
        second = size * (side_of(scene, t, 1) - centre)
        depth = -outside_of(from_incentre(scene, sample), -size * centre, first, second)
    ink = Ink()
    ink.color = color_of(scene, t)
    ink.opacity = 1.0
    ink.coverage = coverage_of(depth + rounding, sample.extent)
    return ink
