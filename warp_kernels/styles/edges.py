"""The edges of the triangles, drawn over what lies below."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

import warp as wp

from warp_kernels.scene import Ink, Sample, Scene, StyleParameters
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.style import Style

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def edge_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The line colour where lines cover the pixel."""
    ink = Ink()
    ink.color = wp.vec3f(parameters.numbers[0], parameters.numbers[1], parameters.numbers[2])
    ink.opacity = 1.0
    ink.coverage = scene.edge_coverage[sample.row, sample.column]
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

    shader: ClassVar[Any] = edge_color
    covers: ClassVar[bool] = False

    @property
    def line_width(self) -> float:
        """Width of the lines [px of the picture]."""
        return self.width

    def numbers(self) -> tuple[float, ...]:
        """Red, green, blue [code values]."""
        return parse_color(self.color)
