"""A picture in every triangle, which makes it brighter and darker."""

import warp as wp

from warp_kernels.elementary import half_angle
from warp_kernels.scene.scene import (
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
from warp_kernels.scene.texels import detail_for, texture_at

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

# Prepared for a triangle:
LEFT = wp.constant(0)
"""Change of the position in the picture per px to the right and down, to the left there."""
UP = wp.constant(2)
"""The same, upwards there."""
DETAIL = wp.constant(4)
"""Level of detail."""
LOOKS = wp.constant(5)
"""How often the picture is looked at for one pixel."""
STEP = wp.constant(6)
"""From one look to the next in the picture, to the right and down there."""
MOST_LOOKS = wp.constant(4)
"""Enough for triangles that are eight times as long as wide; longer ones blur a little."""


@wp.func
def ground_below(scene: Scene, sample: Sample, below: wp.vec4f) -> wp.vec3f:
    """What lies below, and the triangle's mean colour where that is transparent."""
    color = color_of(scene, sample.triangle)
    return color + below[3] * (wp.vec3f(below[0], below[1], below[2]) - color)


@wp.func
def relit(color: wp.vec3f, brightness: float) -> wp.vec3f:
    """A colour made black by brightness 0, white by 1 and left alone by 1/2."""
    dark = wp.min(2.0 * brightness, 1.0) * color
    light = wp.max(2.0 * brightness - 1.0, 0.0)
    return dark + light * (wp.vec3f(255.0, 255.0, 255.0) - dark)


@wp.func
def prepare_texture(scene: Scene, parameters: StyleParameters, triangle: int) -> Numbers:
    """How a triangle lies in the picture, and where to look there for one pixel.

    In flat triangles the picture is pressed together in one direction. Texels that are as fine as
    a pixel there would be far too coarse in the other, so finer ones are looked at in a row.

    Source: McCormack et al., Feline: Fast Elliptical Lines for Anisotropic Texture Mapping (1999).
    """
    first = side_of(scene, triangle, 0)
    second = side_of(scene, triangle, 1)
    area = wp.max(wp.abs(first[0] * second[1] - first[1] * second[0]), 1.0e-6)
    up = wp.vec2f(-first[1], first[0]) / area
    left = wp.vec2f(second[1], -second[0]) / area + 0.5 * up
    result = Numbers()
    for i in range(2):
        result[LEFT + i] = left[i]
        result[UP + i] = up[i]
    along = left[0] * left[0] + up[0] * up[0]
    down = left[1] * left[1] + up[1] * up[1]
    both = left[0] * left[1] + up[0] * up[1]
    spread = wp.sqrt(0.25 * (along - down) * (along - down) + both * both)
    steep = wp.sqrt(0.5 * (along + down) + spread)
    flat = wp.sqrt(wp.max(0.5 * (along + down) - spread, 0.0))
    looks = wp.clamp(wp.ceil(0.5 * steep / wp.max(flat, 1.0e-9)), 1.0, float(MOST_LOOKS))
    step = (scene.pixel / looks) * half_angle(along - down, 2.0 * both)
    result[DETAIL] = detail_for(scene, parameters, steep * scene.pixel / looks)
    result[LOOKS] = looks
    result[STEP] = -wp.dot(left, step)
    result[STEP + 1] = -wp.dot(up, step)
    return result


@wp.func
def textured_color(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """What lies below, relit by the texture; the picture's lower edge is the base edge."""
    n = prepared_for(scene, parameters, sample.triangle)
    left = n[LEFT] * sample.offset[0] + n[LEFT + 1] * sample.offset[1]
    up = n[UP] * sample.offset[0] + n[UP + 1] * sample.offset[1]
    step = wp.vec2f(n[STEP], n[STEP + 1])
    at = wp.vec2f(1.0 - left, 1.0 - up) - 0.5 * (n[LOOKS] - 1.0) * step
    value = float(0.0)
    # always as often, some in vain: many points are looked at together
    for look in range(MOST_LOOKS):
        seen = texture_at(scene, parameters, 0, at, n[DETAIL], False)
        value += wp.where(float(look) < n[LOOKS], seen, 0.0)
        at += step
    brightness = 0.5 + parameters.numbers[0] * (value / n[LOOKS] - 0.5)
    return full_ink(relit(ground_below(scene, sample, below), wp.clamp(brightness, 0.0, 1.0)))
