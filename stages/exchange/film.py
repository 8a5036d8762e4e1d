"""What all frames of an output have in common."""

from dataclasses import dataclass
from fractions import Fraction

from stages.exchange.exchange_options import ExchangeOptions
from stages.look.framing import Framing
from warp_kernels.styles import STYLES, Style


@dataclass(frozen=True)
class Film:
    """The frames of an output, as far as they are known before there is one."""

    name: str
    """Of the source, without its folder and ending."""
    ending: str
    """Ending of the output, with its dot."""
    size: tuple[int, int]
    """Width and height of the source [px]."""
    framing: Framing
    """Where the picture lies on the output."""
    background: tuple[float, float, float] | None
    """What is seen where there is no picture [code values]; None for nothing."""
    styles: tuple[Style, ...]
    """Looks, bottom to top."""
    degree: int
    """Degree of the colours."""
    rate: Fraction | None
    """Frames per second, on the average; None for a still or if unknown."""
    frames: int | None
    """How many frames a file holds, as far as is known."""
    triangles: int | None
    """How many triangles a frame will have; None if its picture decides that, or not known yet."""
    options: ExchangeOptions
    """How shapes are written."""

    @property
    def scale(self) -> tuple[float, float]:
        """Size of the output relative to the source, across and down."""
        across, down = (
            drawn / side for drawn, side in zip(self.framing.picture, self.size, strict=True)
        )
        return across, down

    @property
    def is_on_paper(self) -> bool:
        """Whether it has a size in millimetres."""
        return self.options.mm > 0.0 or self.ending == ".dxf"

    @property
    def names(self) -> list[str]:
        """A name for each look: that of its style, and how often it was there already."""
        styles = [STYLES.name_of(type(style)) for style in self.styles]
        again = [styles[:number].count(name) for number, name in enumerate(styles)]
        return [
            f"{name}{times + 1}" if times else name
            for name, times in zip(styles, again, strict=True)
        ]
