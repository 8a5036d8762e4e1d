"""The edges of the triangles, drawn over what lies below."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

from warp_kernels.registry import Imported, imported
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.style import Style


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
    color: str = field(
        default="#222", metadata={"help": "#rgb, #rrggbb or a name", "form": "color"}
    )
    fade: float = field(
        default=0.0,
        metadata={
            "help": "edges shorter than this are fainter, the shorter the more",
            "unit": "px of the source",
            "range": (0.0, 1000.0),
        },
    )

    portraits: ClassVar[tuple[str, ...]] = ("flat + edges", "source + edges:color=#fff,opacity=0.7")
    prepare = Imported("warp_kernels.styles.shaders.edges:prepare_edges")
    covers: ClassVar[bool] = False

    @property
    def shader(self) -> Any:
        """One that knows of strengths if they differ: looking them up takes its time."""
        name = "faint_edge_color" if self.fade > 0.0 else "edge_color"
        return imported(f"warp_kernels.styles.shaders.edges:{name}")

    def numbers(self) -> tuple[float, ...]:
        """Red, green, blue [code values], half the width, fade."""
        return (*parse_color(self.color), 0.5 * self.width, self.fade)
