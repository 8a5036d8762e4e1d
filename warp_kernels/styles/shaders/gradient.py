"""Every triangle in a colour gradient."""

import warp as wp

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

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def prepare_gradient(scene: Scene, parameters: StyleParameters, triangle: int) -> Numbers:
    """Linear colour from corner 0, and the centroid."""
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
    return result


@wp.func
def bend(scene: Scene, triangle: int, channel: int, right: float, down: float) -> float:
    """What a quadratic colour adds at a place seen from the centroid."""
    first = 12 * triangle + channel
    table = wp.array(ptr=scene.curvatures.ptr, shape=(12 * scene.curvatures.shape[0],), dtype=float)
    bent = right * table[first + 3] + down * table[first + 6]
    return table[first] + right * bent + down * down * table[first + 9]


@wp.func
def limited(scene: Scene, triangle: int, channel: int, value: float) -> float:
    """A value within what the triangle may show."""
    first = 6 * triangle + channel
    table = wp.array(ptr=scene.limits.ptr, shape=(6 * scene.limits.shape[0],), dtype=float)
    return wp.clamp(value, table[first], table[first + 3])


@wp.func
def gradient_color(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """The best linear or quadratic colour at the sample, within what the triangle may show."""
    t = sample.triangle
    n = prepared_for(scene, parameters, t)
    at = sample.offset
    red = n[0] + at[0] * n[3] + at[1] * n[6]
    green = n[1] + at[0] * n[4] + at[1] * n[7]
    blue = n[2] + at[0] * n[5] + at[1] * n[8]
    if scene.curved[0] != 0:
        right = at[0] - n[9]
        down = at[1] - n[10]
        red += bend(scene, t, 0, right, down)
        green += bend(scene, t, 1, right, down)
        blue += bend(scene, t, 2, right, down)
    red = limited(scene, t, 0, red)
    green = limited(scene, t, 1, green)
    return full_ink(wp.vec3f(red, green, limited(scene, t, 2, blue)))
