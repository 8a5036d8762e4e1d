"""How a pixel is written: code values, and straight alpha where nothing is opaque."""

import warp as wp

from warp_kernels.drawing.blend import Coat

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


def channels_of(coats: tuple[Coat, ...]) -> int:
    """Numbers of a pixel: 3, or 4 with alpha if no coat is opaque."""
    return 3 if any(coat.is_opaque for coat in coats) else 4


@wp.func
def code_value(value: float) -> wp.uint8:
    """Round to a code value."""
    return wp.uint8(int(wp.clamp(value, 0.0, 255.0) + 0.5))


@wp.func
def store_opaque(
    out: wp.array(dtype=wp.uint8), k: int, red: float, green: float, blue: float, opacity: float
):
    """Write a pixel through which nothing shows."""
    out[3 * k] = code_value(red)
    out[3 * k + 1] = code_value(green)
    out[3 * k + 2] = code_value(blue)


@wp.func
def store_transparent(
    out: wp.array(dtype=wp.uint8), k: int, red: float, green: float, blue: float, opacity: float
):
    """Write a pixel with straight alpha."""
    whole = wp.max(opacity, 1.0e-6)
    out[4 * k] = code_value(red / whole)
    out[4 * k + 1] = code_value(green / whole)
    out[4 * k + 2] = code_value(blue / whole)
    out[4 * k + 3] = code_value(255.0 * opacity)
