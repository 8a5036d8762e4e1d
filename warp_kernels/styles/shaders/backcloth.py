"""A picture that was drawn before, pixel by pixel."""

import warp as wp

from warp_kernels.scene.scene import Ink, Sample, Scene, StyleParameters, full_ink

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def backcloth_color(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """The picture at the output pixel."""
    rows, columns = scene.ground.shape[0], scene.ground.shape[1]
    table = wp.array(ptr=scene.ground.ptr, shape=(3 * rows * columns,), dtype=wp.uint8)
    at = 3 * (sample.row * columns + sample.column)
    return full_ink(wp.vec3f(float(table[at]), float(table[at + 1]), float(table[at + 2])))
