"""The edges of the triangles, drawn over what lies below."""

import warp as wp

from warp_kernels.scene.scene import (
    Ink,
    Numbers,
    Sample,
    Scene,
    StyleParameters,
    prepared_for,
    side_of,
)
from warp_kernels.scene.triangle_frame import line_coverage, smooth_rise

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

# Prepared for a triangle, after the directions of its three sides:
DISTANCE = wp.constant(6)
"""Distance of corner 0 from the side across from it [px]."""
STRENGTHS = wp.constant(7)
"""How strong the lines along the sides are, where they fade."""


@wp.func
def line_strength(side: wp.vec2f, fade: float) -> float:
    """How strong the line along a side is: short ones are faint."""
    return smooth_rise(wp.length(side) / fade)


@wp.func
def prepare_edges(scene: Scene, parameters: StyleParameters, triangle: int) -> Numbers:
    """The sides as `Scene.lines` has them, and how strong the lines along them are.

    Two sides begin or end in corner 0, from which all is seen: they lie in no distance of it.
    """
    lines = scene.lines[triangle]
    base = side_of(scene, triangle, 0)
    last = side_of(scene, triangle, 1)
    fade = parameters.numbers[4]
    result = Numbers()
    for i in range(3):
        for j in range(2):
            result[2 * i + j] = lines[i, j]
    result[DISTANCE] = lines[1, 2]
    if fade > 0.0:
        result[STRENGTHS] = line_strength(base, fade)
        result[STRENGTHS + 1] = line_strength(last - base, fade)
        result[STRENGTHS + 2] = line_strength(last, fade)
    return result


@wp.func
def side_coverages(
    parameters: StyleParameters, n: Numbers, offset: wp.vec2f, extent: float
) -> wp.vec3f:
    """Part of a point that the line along each side covers."""
    half_width = parameters.numbers[3]
    first = n[0] * offset[0] + n[1] * offset[1]
    second = n[2] * offset[0] + n[3] * offset[1] + n[DISTANCE]
    third = n[4] * offset[0] + n[5] * offset[1]
    return wp.vec3f(
        line_coverage(first, half_width, extent),
        line_coverage(second, half_width, extent),
        line_coverage(third, half_width, extent),
    )


@wp.func
def line_ink(parameters: StyleParameters, covered: wp.vec3f) -> Ink:
    """The line colour where a line covers the point."""
    ink = Ink()
    ink.color = wp.vec3f(parameters.numbers[0], parameters.numbers[1], parameters.numbers[2])
    ink.opacity = 1.0
    # the largest, as none exceeds 1; `max` would ask of each whether it is a number at all
    ink.coverage = wp.clamp(covered[0], wp.clamp(covered[1], covered[2], 1.0), 1.0)
    return ink


@wp.func
def edge_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The line colour where lines cover the point.

    Only the triangle's own sides are looked at: whatever lies outside lies behind one of them.
    """
    n = prepared_for(scene, parameters, sample.triangle)
    return line_ink(parameters, side_coverages(parameters, n, sample.offset, sample.extent))


@wp.func
def faint_edge_color(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """The same, fainter along short sides."""
    n = prepared_for(scene, parameters, sample.triangle)
    strengths = wp.vec3f(n[STRENGTHS], n[STRENGTHS + 1], n[STRENGTHS + 2])
    covered = side_coverages(parameters, n, sample.offset, sample.extent)
    return line_ink(parameters, wp.cw_mul(strengths, covered))
