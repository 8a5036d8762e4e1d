"""Hatching as strokes of pens: a layer a pen, and the paper below."""

from typing import cast

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.plane.hatch import Segments
from stages.exchange.plane.inks import Inks, inks_of
from stages.exchange.plane.strokes import LINES, PENS, strokes_of
from stages.exchange.plane.travel import short_way
from stages.exchange.svg.faces import faces
from stages.exchange.svg.layers import Layer, sheet_of
from stages.exchange.svg.text import elements, filled, hexes, ids_of, rounded
from warp_kernels.styles import Style
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.drawn import NO_PAPER, OWN_PAPER, Drawn
from warp_kernels.styles.tones.ruling import Direction


def hatching(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """Lines along the base edge of each triangle."""
    return _drawn(cast(Drawn, style), figure, film, name, LINES["hatching"])


def crosshatching(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """The same, crossed by others the darker it is."""
    return _drawn(cast(Drawn, style), figure, film, name, LINES["crosshatching"])


def _drawn(
    style: Drawn, figure: Figure, film: Film, name: str, directions: tuple[Direction, ...]
) -> Layer:
    """Strokes in these directions, on their paper if there is any."""
    inks = inks_of(style, figure)
    strokes = strokes_of(style, figure, film, inks, directions)
    order = short_way(figure.mesh.corners.mean(axis=1))
    paths = _paths(strokes, order, film.options.svg_precision)
    ids = ids_of(name, figure.mesh.triangle_ids)
    pens = hexes(inks.pens)
    chosen = [triangle for triangle in order.tolist() if paths[triangle]]
    pen = f'fill="none" stroke-width="{style.weight * style.spacing:.6g}" stroke-linecap="butt"'
    lines = _paper(style, figure, film, name, inks)
    kinds = list(dict.fromkeys(pens[triangle] for triangle in chosen))
    if len(kinds) > PENS:
        columns = ([table[t] for t in chosen] for table in (ids, pens, paths))
        shown = elements('<path id="%s" stroke="%s" d="%s"/>', *columns)
        return Layer([*lines, f"<g {pen}>", *shown, "</g>"], [])
    for number, kind in enumerate(kinds, 1):
        own = [t for t in chosen if pens[t] == kind]
        lines += [
            f'<g id="{name}-pen{number}" inkscape:groupmode="layer" '
            f'inkscape:label="{number} {kind}" {pen} stroke="{kind}">',
            *elements('<path id="%s" d="%s"/>', [ids[t] for t in own], [paths[t] for t in own]),
            "</g>",
        ]
    return Layer(lines, [])


def _paths(strokes: Segments, order: np.ndarray, precision: int) -> list[str]:
    """Path data of every triangle; empty where it has no stroke."""
    data = filled(["M%.9g %.9gL%.9g %.9g"] * len(strokes.ends), rounded(strokes.ends, precision))
    ends = np.cumsum(np.bincount(strokes.triangles, minlength=len(order))).tolist()
    return ["".join(data[begin:end]) for begin, end in zip([0, *ends[:-1]], ends, strict=True)]


def _paper(style: Drawn, figure: Figure, film: Film, name: str, inks: Inks) -> list[str]:
    """What strokes lie on."""
    if style.paper == NO_PAPER:
        return []
    if style.paper != OWN_PAPER and style.colored == 0.0:
        return [sheet_of(figure, np.array(parse_color(style.paper)))]
    label = f"{name}-paper"
    begun = f'<g id="{label}" inkscape:groupmode="layer" inkscape:label="{label}">'
    return [begun, *faces(figure, film, f"{label}-cut", inks.papers), "</g>"]
