"""Every triangle in a colour gradient."""

from dataclasses import dataclass
from typing import Any, ClassVar

import warp as wp

from warp_kernels.scene import Ink, Sample, Scene, StyleParameters, full_ink
from warp_kernels.styles.style import Style

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def gradient_color(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """The best linear or quadratic colour at the sample, within the range of code values."""
    t = sample.triangle
    away = sample.offset - (scene.sides[t, 0] + scene.sides[t, 1]) / 3.0
    color = scene.colors[t] + away[0] * scene.gradients[t, 0] + away[1] * scene.gradients[t, 1]
    if scene.curved[0] != 0:
        bent = away[0] * scene.curvatures[t, 1] + away[1] * scene.curvatures[t, 2]
        color += scene.curvatures[t, 0] + away[0] * bent
        color += away[1] * away[1] * scene.curvatures[t, 3]
    red = wp.clamp(color[0], 0.0, 255.0)
    green = wp.clamp(color[1], 0.0, 255.0)
    return full_ink(wp.vec3f(red, green, wp.clamp(color[2], 0.0, 255.0)))


@dataclass(frozen=True)
class Gradient(Style):
    """Linear colour gradients, and quadratic ones where such colours were optimised.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6c.
    Deviation: the paper has no quadratic colours.
    """

    degree: ClassVar[int] = 1
    shader: ClassVar[Any] = gradient_color
