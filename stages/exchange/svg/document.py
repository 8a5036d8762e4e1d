"""Frames as an SVG document: one is a still, more are shown in turn."""

from fractions import Fraction
from pathlib import Path
from typing import ClassVar
from xml.sax.saxutils import escape

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format
from stages.exchange.svg.layers import LAYERS, layer_of
from stages.exchange.svg.text import hexes
from stages.exchange.svg.turns import too_large, turns
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES

NAMESPACES = (
    'xmlns="http://www.w3.org/2000/svg" '
    'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
)


class Svg(Format):
    """A layer for each style, bottom to top; of each frame, where there are several.

    Source: W3C, Scalable Vector Graphics (SVG) 1.1; layers as Inkscape marks them.
    """

    styles: ClassVar[tuple[str, ...]] = tuple(LAYERS)
    is_drawn: ClassVar[bool] = True

    def __init__(self, film: Film) -> None:
        super().__init__(film)
        self._frames: list[tuple[int, Fraction]] = []
        self._definitions: list[str] = []
        self._shown: list[list[str]] = []
        self._size = 0

    @classmethod
    def check(cls, film: Film) -> None:
        """As every format; paper must be smooth, and gradients straight."""
        super().check(film)
        for style in film.styles:
            if style.degree > 0 and film.degree > 1:
                raise OptionError(
                    f"--color quadratic: {film.ending} holds no colours that bend; use --color "
                    "linear, --style flat, or .png"
                )
            grain = getattr(style, "grain", 0.0)
            if grain > 0.0:
                name = STYLES.name_of(type(style))
                raise OptionError(
                    f"--style {name}:grain={grain:g}: {film.ending} cannot hold a grain; write "
                    f"{name}:grain=0, or use .png"
                )

    def add(self, figure: Figure) -> None:
        """Take a frame.

        Raises:
            OptionError: If the document becomes too large.
        """
        film = self.film
        # ids are those of a still in the first frame, and have its number in each later one
        begin = f"frame{figure.index}-" if self._frames else ""
        names = [begin + name for name in film.names]
        named = list(zip(film.styles, names, strict=True))
        layers = [layer_of(style, figure, film, name) for style, name in named]
        shown: list[str] = []
        for (style, name), layer in zip(named, layers, strict=True):
            shown += [_layer_begin(name, _laid(style.opacity, style.blend)), *layer.elements]
            shown.append("</g>")
        definitions = [line for layer in layers for line in layer.definitions]
        self._frames.append((figure.index, figure.time))
        self._definitions = list(dict.fromkeys([*self._definitions, *definitions]))
        self._shown.append(shown)
        self._size += sum(len(line) + 1 for line in (*shown, *definitions))
        self.notes += [note for layer in layers for note in layer.notes]
        told = too_large(film, self._size, len(self._frames)) if len(self._frames) > 1 else None
        if told is not None:
            raise OptionError(told)

    def save(self, path: Path) -> None:
        """Write what was taken."""
        path.write_text("\n".join(self._lines()) + "\n", "utf-8", newline="\n")

    def _lines(self) -> list[str]:
        """The lines of the document."""
        numbers, times = zip(*self._frames, strict=True)
        lines = _head(self.film, numbers[0], numbers[-1])
        if self._definitions:
            lines += ["<defs>", *self._definitions, "</defs>"]
        lines += _background(self.film)
        if len(numbers) == 1:
            return [*lines, *self._shown[0], "</svg>"]
        for number, turn, shown in zip(
            numbers, turns(list(times), self.film.rate), self._shown, strict=True
        ):
            hidden = "" if number == numbers[0] else ' display="none"'
            lines += [_layer_begin(f"frame{number}", hidden), turn, *shown, "</g>"]
        return [*lines, "</svg>"]


def _head(film: Film, first: int, last: int) -> list[str]:
    """What a document of these frames begins with."""
    width, height = _sides(film)
    shown = f"frame {first}" if first == last else f"frames {first} to {last}"
    return [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg {NAMESPACES} width="{width}" height="{height}" '
        f'viewBox="{_view_box(film)}"{_aspect(film)}>',
        f"<title>{escape(film.name)}, {shown}</title>",
    ]


def _background(film: Film) -> list[str]:
    """What is seen where there is no picture."""
    if film.background is None:
        return []
    x, y, across, down = _view_box(film).split()
    color = hexes(np.rint(film.background).astype(np.uint8)[None])[0]
    return [
        f'<rect id="background" x="{x}" y="{y}" width="{across}" height="{down}" fill="{color}"/>'
    ]


def _layer_begin(name: str, more: str) -> str:
    """The begin of a group that Inkscape shows as a layer."""
    return f'<g id="{name}" inkscape:groupmode="layer" inkscape:label="{name}"{more}>'


def _sides(film: Film) -> tuple[str, str]:
    """Width and height: pixels, or millimetres on paper."""
    width, height = film.framing.canvas
    on_paper = film.options.mm
    if on_paper == 0.0:
        return str(width), str(height)
    return f"{on_paper:.6g}mm", f"{on_paper * height / width:.6g}mm"


def _view_box(film: Film) -> str:
    """What part of the plane of the picture the output shows [px of the source]."""
    sides = zip(film.framing.offset, film.framing.canvas, film.scale, strict=True)
    begins, lengths = zip(*((-off / by, out / by) for off, out, by in sides), strict=True)
    return " ".join(f"{number + 0.0:.9g}" for number in (*begins, *lengths))


def _aspect(film: Film) -> str:
    """What is said of pixels that are scaled more in one direction, if by rounding alone."""
    across, down = film.scale
    return "" if across == down else ' preserveAspectRatio="none"'


def _laid(opacity: float, blend: str) -> str:
    """How a layer lies on what is below."""
    told = "" if opacity == 1.0 else f' opacity="{opacity:.6g}"'
    return told if blend == "normal" else f'{told} style="mix-blend-mode:{blend}"'
