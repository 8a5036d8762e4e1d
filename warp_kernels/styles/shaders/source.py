"""The source picture itself."""

import warp as wp

from warp_kernels.scene.scene import Ink, Sample, Scene, StyleParameters, full_ink
from warp_kernels.scene.source_picture import source_at

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def source_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The picture at the middle of the output pixel: where a border runs it is no softer."""
    return full_ink(source_at(scene, sample.middle))
