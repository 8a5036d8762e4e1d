"""Every triangle packed with discs."""

from dataclasses import dataclass, field
from typing import ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.style import Style


@dataclass(frozen=True)
class Circles(Style):
    """Discs: the incircle, and from it a chain of ever smaller ones into each corner.

    Deviation: the paper draws the incircle alone.
    """

    gap: float = field(
        default=0.6,
        metadata={"help": "space between discs", "unit": "px of the source", "range": (0.0, 20.0)},
    )
    smallest: float = field(
        default=0.8,
        metadata={
            "help": "radius of the smallest disc",
            "unit": "px of the source",
            "range": (0.05, 100.0),
        },
    )

    shader = Imported("warp_kernels.styles.shaders.circles:packed_color")
    portraits: ClassVar[tuple[str, ...]] = ("paper + circles",)
    covers: ClassVar[bool] = False

    def numbers(self) -> tuple[float, ...]:
        """Gap, smallest radius."""
        return self.gap, self.smallest
