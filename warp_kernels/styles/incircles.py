"""A soft disc in the incircle of every triangle."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

import warp as wp

from warp_kernels.scene.scene import Ink, Sample, Scene, StyleParameters, color_of
from warp_kernels.scene.triangle_frame import coverage_of, from_incentre, inradius, smooth_rise
from warp_kernels.styles.style import Style

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def incircle_color(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """The triangle's mean colour, which fades towards the rim."""
    radius = inradius(scene, sample) * parameters.numbers[0]
    away = wp.length(from_incentre(scene, sample))
    softness = wp.max(parameters.numbers[1], 1.0e-3)
    ink = Ink()
    ink.color = color_of(scene, sample.triangle)
    ink.opacity = 1.0 - smooth_rise((away / radius - 1.0 + softness) / softness)
    ink.coverage = coverage_of(radius - away, sample.extent)
    return ink


@dataclass(frozen=True)
class Incircles(Style):
    """Discs around the incentres whose opacity is 1 - (3 r^2 - 2 r^3), r = 1 at the rim.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6.
    Deviation: size and softness can be chosen; what is outside stays transparent.
    """

    size: float = field(
        default=1.0, metadata={"help": "radius relative to the incircle", "range": (0.1, 4.0)}
    )
    softness: float = field(
        default=1.0,
        metadata={"help": "part of the radius over which a disc fades", "range": (0.0, 1.0)},
    )

    shader: ClassVar[Any] = incircle_color
    portraits: ClassVar[tuple[str, ...]] = (
        "paper:color=#111,grain=0 + flat:opacity=0.3 + incircles",
    )
    covers: ClassVar[bool] = False

    def numbers(self) -> tuple[float, ...]:
        """Size, softness."""
        return self.size, self.softness
