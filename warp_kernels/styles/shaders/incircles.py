"""A soft disc in the incircle of every triangle."""

import warp as wp

from warp_kernels.scene.scene import Ink, Sample, Scene, StyleParameters, color_of
from warp_kernels.scene.triangle_frame import coverage_of, from_incentre, inradius, smooth_rise

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def incircle_color(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """The triangle's mean colour, which fades towards the rim."""
    radius = inradius(scene, sample) * parameters.numbers[0]
    away = wp.length(from_incentre(scene, sample))
    softness = wp.max(parameters.numbers[1], 1.0e-3)
    ink = Ink()
    ink.color = color_of(scene, sample.triangle)
    ink.opacity = 1.0 - smooth_rise((away / radius - 1.0 + softness) / softness)
    ink.coverage = coverage_of(radius - away, sample.extent)
    return ink
