"""The source picture itself."""

from dataclasses import dataclass
from typing import Any, ClassVar

import warp as wp

from warp_kernels.scene.scene import Ink, Sample, Scene, StyleParameters, full_ink
from warp_kernels.scene.source_picture import source_at
from warp_kernels.styles.style import Style

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def source_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The picture at the middle of the output pixel: where a border runs it is no softer."""
    middle = wp.vec2i(scene.columns[sample.column], scene.rows[sample.row])
    return full_ink(source_at(scene, middle))


@dataclass(frozen=True)
class Source(Style):
    """The original, to see through other styles or to draw on.

    Deviation: the paper draws its styles on flat grounds.
    """

    shader: ClassVar[Any] = source_color
    needs_source: ClassVar[bool] = True
