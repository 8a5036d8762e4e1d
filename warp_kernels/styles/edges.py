"""The edges of the triangles, drawn over what lies below."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

import warp as wp

from warp_kernels.scene import Ink, Sample, Scene, StyleParameters, depths
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.style import Style
from warp_kernels.triangle_frame import line_coverage, smooth_rise

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def line_strength(side: wp.vec2f, fade: float) -> float:
    """How strong the line along a side is: short ones are faint."""
    return smooth_rise(wp.length(side) / fade)


@wp.func
def edge_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The line colour where lines cover the point.

    Only the triangle's own sides are looked at: whatever lies outside lies behind one of them.
    """
    t = sample.triangle
    half_width = parameters.numbers[3]
    away = depths(scene.lines[t], sample.offset)
    ink = Ink()
    ink.color = wp.vec3f(parameters.numbers[0], parameters.numbers[1], parameters.numbers[2])
    ink.opacity = 1.0
    ink.coverage = line_coverage(wp.min(away), half_width, sample.extent)
    fade = parameters.numbers[4]
    if fade > 0.0 and ink.coverage > 0.0:
        base = scene.sides[t, 0]
        last = scene.sides[t, 1]
        strengths = wp.vec3f(
            line_strength(base, fade), line_strength(last - base, fade), line_strength(last, fade)
        )
        for c in range(3):
            strengths[c] *= line_coverage(away[c], half_width, sample.extent)
        ink.coverage = wp.max(strengths)
    return ink


@dataclass(frozen=True)
class Edges(Style):
    """Anti-aliased edges.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6f.
    Deviation: coverage is analytic instead of multi-sampled.
    """

    width: float = field(
        default=1.0,
        metadata={"help": "width of the lines", "unit": "px of the source", "range": (0.1, 50.0)},
    )
    color: str = field(default="#222", metadata={"help": "#rgb or #rrggbb", "form": "color"})
    fade: float = field(
        default=0.0,
        metadata={
            "help": "edges shorter than this are fainter, the shorter the more",
            "unit": "px of the source",
            "range": (0.0, 1000.0),
        },
    )

    shader: ClassVar[Any] = edge_color
    covers: ClassVar[bool] = False

    def numbers(self) -> tuple[float, ...]:
        """Red, green, blue [code values], half the width, fade."""
        return (*parse_color(self.color), 0.5 * self.width, self.fade)
