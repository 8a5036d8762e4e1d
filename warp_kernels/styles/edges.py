"""The edges of the triangles, drawn over what lies below."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

import warp as wp

from warp_kernels.scene import Ink, Numbers, Sample, Scene, StyleParameters, prepared_for, side_of
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.style import Style
from warp_kernels.triangle_frame import line_coverage, smooth_rise

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def line_strength(side: wp.vec2f, fade: float) -> float:
    """How strong the line along a side is: short ones are faint."""
    return smooth_rise(wp.length(side) / fade)


@wp.func
def prepare_edges(scene: Scene, parameters: StyleParameters, triangle: int) -> Numbers:
    """The sides as `Scene.lines` has them, and how strong the lines along them are."""
    lines = scene.lines[triangle]
    base = side_of(scene, triangle, 0)
    last = side_of(scene, triangle, 1)
    fade = parameters.numbers[4]
    result = Numbers()
    for i in range(3):
        for j in range(3):
            result[3 * i + j] = lines[i, j]
        result[9 + i] = 1.0
    if fade > 0.0:
        result[9] = line_strength(base, fade)
        result[10] = line_strength(last - base, fade)
        result[11] = line_strength(last, fade)
    return result


@wp.func
def edge_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The line colour where lines cover the point.

    Only the triangle's own sides are looked at: whatever lies outside lies behind one of them.
    """
    n = prepared_for(scene, parameters, sample.triangle)
    x = sample.offset[0]
    y = sample.offset[1]
    half_width = parameters.numbers[3]
    first = n[0] * x + n[1] * y + n[2]
    second = n[3] * x + n[4] * y + n[5]
    third = n[6] * x + n[7] * y + n[8]
    ink = Ink()
    ink.color = wp.vec3f(parameters.numbers[0], parameters.numbers[1], parameters.numbers[2])
    ink.opacity = 1.0
    ink.coverage = wp.max(
        n[9] * line_coverage(first, half_width, sample.extent),
        wp.max(
            n[10] * line_coverage(second, half_width, sample.extent),
            n[11] * line_coverage(third, half_width, sample.extent),
        ),
    )
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
    portraits: ClassVar[tuple[str, ...]] = ("flat + edges", "source + edges:color=#fff,opacity=0.7")
    prepare: ClassVar[Any] = prepare_edges
    covers: ClassVar[bool] = False

    def numbers(self) -> tuple[float, ...]:
        """Red, green, blue [code values], half the width, fade."""
        return (*parse_color(self.color), 0.5 * self.width, self.fade)
