"""Every triangle in a colour gradient."""

from dataclasses import dataclass
from typing import Any, ClassVar

import warp as wp

from warp_kernels.scene import (
    Ink,
    Numbers,
    Sample,
    Scene,
    StyleParameters,
    color_of,
    full_ink,
    prepared_for,
    side_of,
)
from warp_kernels.styles.style import Style

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def prepare_gradient(scene: Scene, parameters: StyleParameters, triangle: int) -> Numbers:
    """Linear colour from corner 0, the centroid, and whether the colour is curved."""
    centre = (side_of(scene, triangle, 0) + side_of(scene, triangle, 1)) / 3.0
    right = scene.gradients[triangle, 0]
    down = scene.gradients[triangle, 1]
    start = color_of(scene, triangle) - centre[0] * right - centre[1] * down
    result = Numbers()
    for c in range(3):
        result[c] = start[c]
        result[3 + c] = right[c]
        result[6 + c] = down[c]
    result[9] = centre[0]
    result[10] = centre[1]
    result[11] = float(scene.curved[0])
    return result


@wp.func
def curvature_of(scene: Scene, triangle: int, number: int) -> wp.vec3f:
    """A term of a quadratic colour, see `Scene`."""
    red = scene.curvatures[triangle, number, 0]
    green = scene.curvatures[triangle, number, 1]
    return wp.vec3f(red, green, scene.curvatures[triangle, number, 2])


@wp.func
def gradient_color(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """The best linear or quadratic colour at the sample, within the range of code values."""
    t = sample.triangle
    n = prepared_for(scene, parameters, t)
    at = sample.offset
    color = wp.vec3f(
        n[0] + at[0] * n[3] + at[1] * n[6],
        n[1] + at[0] * n[4] + at[1] * n[7],
        n[2] + at[0] * n[5] + at[1] * n[8],
    )
    if n[11] != 0.0:
        away = at - wp.vec2f(n[9], n[10])
        bent = away[0] * curvature_of(scene, t, 1) + away[1] * curvature_of(scene, t, 2)
        color += curvature_of(scene, t, 0) + away[0] * bent
        color += away[1] * away[1] * curvature_of(scene, t, 3)
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
    prepare: ClassVar[Any] = prepare_gradient
