"""Every triangle in a linear colour gradient."""

from dataclasses import dataclass
from typing import Any, ClassVar

import warp as wp

from warp_kernels.scene import Sample, Scene, StyleParameters

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def gradient_color(scene: Scene, parameters: StyleParameters, sample: Sample) -> wp.vec4f:
    """The best linear colour at the sample, within the range of code values."""
    t = sample.triangle
    away = sample.position - scene.centres[t]
    color = scene.colors[t] + away[0] * scene.gradients[t, 0] + away[1] * scene.gradients[t, 1]
    return wp.vec4f(
        wp.clamp(color[0], 0.0, 255.0),
        wp.clamp(color[1], 0.0, 255.0),
        wp.clamp(color[2], 0.0, 255.0),
        1.0,
    )


@dataclass(frozen=True)
class Gradient:
    """Linear colour gradients.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6c.
    """

    degree: ClassVar[int] = 1
    shader: ClassVar[Any] = gradient_color

    @property
    def line_width(self) -> float:
        """No edges are drawn."""
        return 0.0

    def parameters(self) -> tuple[float, ...]:
        """None."""
        return ()
