"""A frame as an SVG document."""

from pathlib import Path
from typing import ClassVar
from xml.sax.saxutils import escape

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format
from stages.exchange.svg.layers import LAYERS, Layer, layer_of
from stages.exchange.svg.text import hexes
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES

NAMESPACES = (
    'xmlns="http://www.w3.org/2000/svg" '
    'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
)


class Svg(Format):
    """One frame: a layer for each style, bottom to top.

    Source: W3C, Scalable Vector Graphics (SVG) 1.1; layers as Inkscape marks them.
    """

    styles: ClassVar[tuple[str, ...]] = tuple(LAYERS)
    is_drawn: ClassVar[bool] = True

    def __init__(self, film: Film) -> None:
        super().__init__(film)
        self._text = ""

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
        """Take the frame."""
        film = self.film
        named = list(zip(film.styles, names_of(film), strict=True))
        layers = [layer_of(style, figure, film, name) for style, name in named]
        self._text = "\n".join(_document(film, figure, layers)) + "\n"
        self.notes += [note for layer in layers for note in layer.notes]

    def save(self, path: Path) -> None:
        """Write it."""
        path.write_text(self._text, "utf-8", newline="\n")


def names_of(film: Film) -> list[str]:
    """A name for each layer: that of its style, and how often it was there already."""
    styles = [STYLES.name_of(type(style)) for style in film.styles]
    again = [styles[:number].count(name) for number, name in enumerate(styles)]
    return [
        f"{name}{times + 1}" if times else name for name, times in zip(styles, again, strict=True)
    ]


def _document(film: Film, figure: Figure, layers: list[Layer]) -> list[str]:
    """The lines of a document."""
    width, height = _sides(film)
    box = _view_box(film)
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg {NAMESPACES} width="{width}" height="{height}" viewBox="{box}"{_aspect(film)}>',
        f"<title>{escape(film.name)}, frame {figure.index}</title>",
    ]
    definitions = [line for layer in layers for line in layer.definitions]
    if definitions:
        lines += ["<defs>", *definitions, "</defs>"]
    if film.background is not None:
        x, y, across, down = box.split()
        color = hexes(np.rint(film.background).astype(np.uint8)[None])[0]
        lines.append(
            f'<rect id="background" x="{x}" y="{y}" width="{across}" height="{down}" '
            f'fill="{color}"/>'
        )
    for style, layer, name in zip(film.styles, layers, names_of(film), strict=True):
        lines.append(
            f'<g id="{name}" inkscape:groupmode="layer" inkscape:label="{name}"'
            f"{_laid(style.opacity, style.blend)}>"
        )
        lines += [*layer.elements, "</g>"]
    return [*lines, "</svg>"]


def _sides(film: Film) -> tuple[str, str]:
    """Width and height: pixels, or millimetres on paper."""
    width, height = film.framing.canvas
    on_paper = film.options.svg_mm
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
