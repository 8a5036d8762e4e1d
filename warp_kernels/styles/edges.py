"""The edges of the triangles, drawn over what lies below."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

import warp as wp

from warp_kernels.errors import OptionError
from warp_kernels.scene import Sample, Scene, StyleParameters
from warp_kernels.styles.color import parse_color

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def edge_color(scene: Scene, parameters: StyleParameters, sample: Sample) -> wp.vec4f:
    """The line colour, as opaque as lines cover the pixel."""
    covered = scene.edge_coverage[sample.row, sample.column]
    return wp.vec4f(parameters[0], parameters[1], parameters[2], covered * parameters[3])


@dataclass(frozen=True)
class Edges:
    """Anti-aliased edges.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6f.
    Deviation: coverage is analytic instead of multi-sampled.

    Raises:
        OptionError: If a parameter is out of its range.
    """

    width: float = field(
        default=1.0, metadata={"help": "width of the lines [px of the source], 0.1 to 50"}
    )
    color: str = field(default="#222", metadata={"help": "colour, #rgb or #rrggbb"})
    opacity: float = field(default=1.0, metadata={"help": "0 (invisible) to 1 (opaque)"})

    degree: ClassVar[int] = 0
    shader: ClassVar[Any] = edge_color

    def __post_init__(self) -> None:
        if not 0.1 <= self.width <= 50.0:
            raise OptionError(f"edges:width={self.width:g}: must lie between 0.1 and 50 px")
        if not 0.0 <= self.opacity <= 1.0:
            raise OptionError(f"edges:opacity={self.opacity:g}: must lie between 0 and 1")
        parse_color(self.color)

    @property
    def line_width(self) -> float:
        """Width of the lines [px of the picture]."""
        return self.width

    def parameters(self) -> tuple[float, ...]:
        """Red, green, blue [code values], opacity."""
        return (*parse_color(self.color), self.opacity)
