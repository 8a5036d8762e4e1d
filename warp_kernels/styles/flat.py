"""Every triangle in its mean colour."""

from dataclasses import dataclass
from typing import Any, ClassVar

import warp as wp

from warp_kernels.scene import Sample, Scene, StyleParameters

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def flat_color(scene: Scene, parameters: StyleParameters, sample: Sample) -> wp.vec4f:
    """The triangle's mean colour."""
    color = scene.colors[sample.triangle]
    return wp.vec4f(color[0], color[1], color[2], 1.0)


@dataclass(frozen=True)
class Flat:
    """Constant colours.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6b.
    """

    degree: ClassVar[int] = 0
    shader: ClassVar[Any] = flat_color

    @property
    def line_width(self) -> float:
        """No edges are drawn."""
        return 0.0

    def parameters(self) -> tuple[float, ...]:
        """None."""
        return ()
