"""Code values as amounts of light and back: light is taken as the square of a code value.

Deviation: sRGB's transfer curve has a linear toe and an exponent of 2.4; with an exponent of 2 the
half between black and white is code value 180 instead of 188, for a small part of the time.
"""

import warp as wp

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def to_light(color: wp.vec3f) -> wp.vec3f:
    """Code values as amounts of light."""
    return wp.cw_mul(color, color)


@wp.func
def to_code(light: wp.vec3f) -> wp.vec3f:
    """Amounts of light as code values."""
    return wp.vec3f(wp.sqrt(light[0]), wp.sqrt(light[1]), wp.sqrt(light[2]))
