"""A glass lens on every triangle, through which the source picture is seen."""

from dataclasses import dataclass, field
from typing import ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.style import Style


@dataclass(frozen=True)
class Lenses(Style):
    """Gaussian lenses at the incentres, rays refracted to the source picture below.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6.
    Deviation: highlights and shadows show the glass.
    """

    size: float = field(
        default=0.5,
        metadata={"help": "standard deviation relative to the inradius", "range": (0.05, 3.0)},
    )
    height: float = field(
        default=0.7, metadata={"help": "height relative to the inradius", "range": (0.0, 5.0)}
    )
    index: float = field(
        default=1.5, metadata={"help": "refractive index of the glass", "range": (1.0, 3.0)}
    )
    shine: float = field(
        default=0.7, metadata={"help": "strength of highlights and shadows", "range": (0.0, 1.0)}
    )
    depth: float = field(
        default=4.0,
        metadata={
            "help": "thickness of the glass below, relative to the inradius",
            "range": (0.0, 10.0),
        },
    )

    shader = Imported("warp_kernels.styles.shaders.lenses:lens_color")
    needs_source: ClassVar[bool] = True

    def numbers(self) -> tuple[float, ...]:
        """Size, height, index, shine, depth."""
        return self.size, self.height, self.index, self.shine, self.depth
