"""A frame as a DXF drawing."""

from pathlib import Path
from typing import ClassVar

from stages.exchange.dxf.cuts import CUTS
from stages.exchange.dxf.sheet import Sheet, ezdxf
from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES

SQUARE = 0.02
"""How much pixels may differ from squares, by the rounding of sizes: arcs stay arcs."""


class Dxf(Format):
    """Lines in millimetres, a layer a look and a colour.

    Source: Autodesk, DXF Reference (2012).
    """

    styles: ClassVar[tuple[str, ...]] = tuple(CUTS)
    is_drawn: ClassVar[bool] = True

    def __init__(self, film: Film) -> None:
        super().__init__(film)
        self._sheet = Sheet(film)

    @classmethod
    def check(cls, film: Film) -> None:
        """As every format; lines are neither cut off nor stretched nor seen through."""
        super().check(film)
        ezdxf()
        across, down = film.scale
        if abs(across / down - 1.0) > SQUARE:
            raise OptionError(f"--fit stretch: {film.ending} keeps circles round; use contain")
        if min(film.framing.offset) < 0:
            raise OptionError(f"--fit cover: {film.ending} cuts nothing off; use contain")
        for style in film.styles:
            name = STYLES.name_of(type(style))
            if style.opacity != 1.0 or style.blend != "normal":
                raise OptionError(
                    f"--style {name}: {film.ending} cannot hold opacity and blend; leave them out"
                )

    def add(self, figure: Figure) -> None:
        """Take the frame."""
        film = self.film
        for style, name in zip(film.styles, film.names, strict=True):
            CUTS[STYLES.name_of(type(style))](style, figure, film, name, self._sheet)

    def save(self, path: Path) -> None:
        """Write it."""
        self._sheet.save(path)
