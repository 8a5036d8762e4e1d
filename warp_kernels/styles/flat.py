"""Every triangle in its mean colour."""

from dataclasses import dataclass
from typing import Any, ClassVar

import warp as wp

from warp_kernels.scene.scene import Ink, Sample, Scene, StyleParameters, color_of, full_ink
from warp_kernels.styles.style import Style

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def flat_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The triangle's mean colour."""
    return full_ink(color_of(scene, sample.triangle))


@dataclass(frozen=True)
class Flat(Style):
    """Constant colours.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6b.
    """

    shader: ClassVar[Any] = flat_color
    is_even: ClassVar[bool] = True
