"""A glass lens on every triangle, through which the source picture is seen."""

import warp as wp

from warp_kernels.elementary import exponential, power_of_90
from warp_kernels.scene.scene import FIXED, Ink, Sample, Scene, StyleParameters, full_ink
from warp_kernels.scene.source_picture import source_at
from warp_kernels.scene.triangle_frame import from_incentre, inradius

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

_WHITE = wp.constant(wp.vec3f(255.0, 255.0, 255.0))
_SHADOW = wp.constant(wp.vec3f(0.6, 0.8, 0.0))
_LIGHT = wp.constant(wp.vec3f(-0.45, -0.6, 0.66))
"""Where the light of the highlights comes from: from the upper left, above the picture."""


@wp.func
def refracted(normal: wp.vec3f, index: float) -> wp.vec2f:
    """How far a ray from straight above is carried aside, per px that it descends in the glass."""
    ratio = 1.0 / index
    cosine = normal[2]
    bend = wp.sqrt(1.0 - ratio * ratio * (1.0 - cosine * cosine)) - ratio * cosine
    aside = -bend / (ratio + bend * cosine)
    return wp.vec2f(aside * normal[0], aside * normal[1])


@wp.func
def lens_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The source where the refracted ray meets it, and a highlight."""
    radius = inradius(scene, sample)
    width = parameters.numbers[0] * radius
    p = from_incentre(scene, sample)
    narrow = 1.0 / (width * width)
    height = parameters.numbers[1] * radius * exponential(-0.5 * narrow * wp.length_sq(p))
    slope = -height * narrow * p
    normal = wp.normalize(wp.vec3f(-slope[0], -slope[1], 1.0))
    depth = height + parameters.numbers[4] * radius
    moved = FIXED * depth * refracted(normal, parameters.numbers[2])
    place = sample.place + wp.vec2i(int(wp.rint(moved[0])), int(wp.rint(moved[1])))
    color = source_at(scene, place)
    # glass that turns away from the viewer mirrors the dark around it, or the light
    light = wp.max(wp.dot(normal, wp.normalize(_LIGHT + wp.vec3f(0.0, 0.0, 1.0))), 0.0)
    shine = parameters.numbers[3] * power_of_90(light)
    shade = 1.0 - 0.7 * parameters.numbers[3] * (1.0 - normal[2]) * (1.0 + wp.dot(normal, _SHADOW))
    return full_ink(wp.max(shade, 0.0) * color + shine * (_WHITE - wp.max(shade, 0.0) * color))
