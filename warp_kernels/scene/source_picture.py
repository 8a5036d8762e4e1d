"""The source picture under the triangles: how it reaches the device and how shaders look at it."""

import numpy as np
import warp as wp

from warp_kernels.scene.scene import FIXED, FRACTION_BITS, Scene

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

_BITS = wp.constant(FRACTION_BITS)
_MASK = wp.constant((1 << FRACTION_BITS) - 1)


def step_for(picture: tuple[int, int], output: tuple[int, int]) -> int:
    """By what whole factor a picture is reduced before it is looked at: none is skipped over.

    Args:
        picture: Width and height of the picture [px].
        output: Width and height of the output [px].
    """
    return max(1, min(picture[0] // output[0], picture[1] // output[1]))


def reduced(pixels: np.ndarray, step: int) -> np.ndarray:
    """Means of blocks of `step` x `step` pixels; the last block of a row may be smaller.

    Args:
        pixels: Code values, [H, W, 3] uint8.
        step: Side of a block [px].
    """
    if step == 1:
        return pixels
    height, width = pixels.shape[:2]
    down, right = -height % step, -width % step
    whole = np.pad(pixels, ((0, down), (0, right), (0, 0)), mode="edge").astype(np.uint32)
    rows = sum(whole[i::step] for i in range(step))
    sums = sum(rows[:, i::step] for i in range(step))
    return ((sums + step * step // 2) // (step * step)).astype(np.uint8)


@wp.func
def _pixel(picture: wp.array2d(dtype=wp.vec3ub), row: int, column: int) -> wp.vec3f:
    """A pixel of the picture, or the nearest one; without the scene, which would be copied."""
    color = picture[
        wp.clamp(row, 0, picture.shape[0] - 1), wp.clamp(column, 0, picture.shape[1] - 1)
    ]
    return wp.vec3f(float(color[0]), float(color[1]), float(color[2]))


@wp.func
def source_at(scene: Scene, place: wp.vec2i) -> wp.vec3f:
    """The source picture at a place [2^-16 px], bilinear [code values]."""
    x = place[0] // scene.source_step - (1 << (_BITS - 1))
    y = place[1] // scene.source_step - (1 << (_BITS - 1))
    column = x >> _BITS
    row = y >> _BITS
    right = float(x & _MASK) / FIXED
    down = float(y & _MASK) / FIXED
    color = wp.vec3f()
    for i in range(2):
        for j in range(2):
            weight = wp.where(i == 0, 1.0 - down, down) * wp.where(j == 0, 1.0 - right, right)
            color += weight * _pixel(scene.source, row + i, column + j)
    return color
