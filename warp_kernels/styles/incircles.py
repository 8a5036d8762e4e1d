"""A soft disc in the incircle of every triangle."""

from dataclasses import dataclass, field
from typing import ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.style import Style


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

    shader = Imported("warp_kernels.styles.shaders.incircles:incircle_color")
    portraits: ClassVar[tuple[str, ...]] = (
        "paper:color=#111,grain=0 + flat:opacity=0.3 + incircles",
    )
    covers: ClassVar[bool] = False

    def numbers(self) -> tuple[float, ...]:
        """Size, softness."""
        return self.size, self.softness
