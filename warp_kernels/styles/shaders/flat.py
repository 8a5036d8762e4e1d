"""Every triangle in its mean colour."""

import warp as wp

from warp_kernels.scene.scene import Ink, Sample, Scene, StyleParameters, color_of, full_ink

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def flat_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The triangle's mean colour."""
    return full_ink(color_of(scene, sample.triangle))
