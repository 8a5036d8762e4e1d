"""Every triangle drawn a little smaller, with gaps between them."""

from dataclasses import dataclass, field
from typing import ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.style import Style


@dataclass(frozen=True)
class Shrink(Style):
    """Triangles drawn about their incentre: gaps between them have the same width everywhere.

    Deviation: not in the paper.
    """

    gap: float = field(
        default=2.0,
        metadata={"help": "width of the gaps", "unit": "px of the source", "range": (0.0, 100.0)},
    )
    smallest: float = field(
        default=0.55,
        metadata={"help": "least part of its size that a triangle keeps", "range": (0.0, 1.0)},
    )
    rounding: float = field(
        default=0.3,
        metadata={"help": "roundness of corners, 1 makes discs", "range": (0.0, 1.0)},
    )

    shader = Imported("warp_kernels.styles.shaders.shrink:shrunk_color")
    portraits: ClassVar[tuple[str, ...]] = ("paper:color=#111,grain=0 + shrink",)
    covers: ClassVar[bool] = False

    def numbers(self) -> tuple[float, ...]:
        """Gap, smallest, rounding."""
        return self.gap, self.smallest, self.rounding
