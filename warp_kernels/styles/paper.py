"""Paper with a grain, of which every triangle is a cut."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.style import ReadPicture, Style

if TYPE_CHECKING:
    from warp_kernels.scene.texels import Texels


@dataclass(frozen=True)
class Paper(Style):
    """Paper of one colour, cut along the triangles: a ground for other styles.

    With `blend=multiply` and white it gives a grain to what lies below.

    Deviation: not in the paper.
    """

    color: str = field(
        default="#f3eee3", metadata={"help": "#rgb, #rrggbb or a name", "form": "color"}
    )
    grain: float = field(
        default=0.4, metadata={"help": "contrast of the grain", "range": (0.0, 4.0)}
    )
    size: float = field(
        default=256.0,
        metadata={
            "help": "after so much the grain repeats",
            "unit": "px of the source",
            "range": (8.0, 8192.0),
        },
    )
    sheets: float = field(
        default=0.02,
        metadata={"help": "difference of brightness between cuts", "range": (0.0, 1.0)},
    )

    shader = Imported("warp_kernels.styles.shaders.paper:paper_color")
    prepare = Imported("warp_kernels.styles.shaders.paper:prepare_paper")
    portraits: ClassVar[tuple[str, ...]] = ("flat + paper:color=#fff,blend=multiply",)

    @property
    def ground(self) -> str | None:
        """The paper, unless it only gives its grain to what lies below."""
        return self.color if self.blend == "normal" else None

    @property
    def is_sheet(self) -> bool:
        """Unless something shows through."""
        return self.hides_below

    def numbers(self) -> tuple[float, ...]:
        """Red, green, blue [code values], grain, size, sheets."""
        return (*parse_color(self.color), self.grain, self.size, self.sheets)

    def texture(self, read: ReadPicture) -> "Texels | None":
        """The grain."""
        from warp_kernels.scene.texels import Texels
        from warp_kernels.styles.shaders.paper import grain

        return Texels.of(grain()[None]).with_neighbours(repeats=True)
