"""Triangles in linear colours.

A gradient of SVG has one direction, and each channel of a triangle has its own. So three layers,
each of one channel, are added up: `screen` of colours that have no channel in common is their sum.
Over them lies one gradient a triangle, the nearest, for programs that know no blend modes. Those
that do multiply it with black and add that, so that it is not seen; browsers are told not to draw
it at all.

Source: W3C, Compositing and Blending Level 1, Sec. 10.1; CSS Conditional Rules Level 3, Sec. 6.
"""

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.svg.layers import Layer, ground_of, sheet_of
from stages.exchange.svg.outlines import triangle_outlines
from stages.exchange.svg.slopes import Slopes, best_slopes, channel_slopes
from stages.exchange.svg.text import elements, hexes, ids_of, lines_of, path_data, rounded
from warp_kernels.styles import Style

DECIMALS = 3
"""Of the places of colours, at least: in steep ones a hundredth of a px can be a code value."""
HIDING = "<style>@supports (mix-blend-mode:screen){.plain{display:none}}</style>"
"""Saves programs that understand it the drawing of what would not be seen."""


def gradient(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """Three layers of one channel each, and one gradient a triangle over them or alone."""
    mesh, options = figure.mesh, film.options
    outlines = triangle_outlines(mesh)
    data = path_data(outlines.points, outlines.counts, options.svg_precision)
    ids = ids_of(name, mesh.triangle_ids)
    decimals = max(DECIMALS, options.svg_precision)
    slopes, errors = best_slopes(figure.paint)
    fills, definitions = _fills(slopes, [f"{one}-fill" for one in ids], decimals)
    shown = elements('<path id="%s" fill="%s" d="%s"/>', ids, fills, data)
    error = float(np.sqrt((errors * mesh.areas).sum() / mesh.areas.sum()))
    if options.svg_gradients == "plain":
        note = f"single gradients are off by about {error:.0f} code values (root mean square)"
        return Layer([ground_of(figure), *shown], definitions, (note,))
    lines = ['<g style="isolation:isolate">']
    for channel, letter in enumerate("rgb"):
        slopes = channel_slopes(figure.paint, channel)
        fills, more = _fills(slopes, [f"{one}-{letter}" for one in ids], decimals)
        definitions += more
        mixed = ' style="mix-blend-mode:screen"' if channel else ""
        color = np.where(np.arange(3) == channel, figure.mean_color, 0)
        lines += [f"<g{mixed}>", sheet_of(figure, color)]
        lines += [*elements('<path fill="%s" d="%s"/>', fills, data), "</g>"]
    lines += ['<g class="plain" style="mix-blend-mode:screen">', sheet_of(figure, np.zeros(3))]
    lines += ['<g style="mix-blend-mode:multiply">', ground_of(figure), *shown, "</g>", "</g>"]
    return Layer([*lines, "</g>"], [HIDING, *definitions])


def _fills(slopes: Slopes, ids: list[str], decimals: int) -> tuple[list[str], list[str]]:
    """What stands in `fill`, and the gradients that it names."""
    first, last = hexes(slopes.first), hexes(slopes.last)
    is_even = slopes.is_even
    fills = [
        color if even else f"url(#{one})"
        for one, color, even in zip(ids, first, is_even.tolist(), strict=True)
    ]
    steep = np.flatnonzero(~is_even)
    numbers = rounded(np.concatenate([slopes.begins, slopes.ends], axis=1)[steep], decimals)
    places = lines_of('x1="%.9g" y1="%.9g" x2="%.9g" y2="%.9g"', numbers)
    named = [(ids[i], first[i], last[i]) for i in steep.tolist()]
    form = (
        '<linearGradient id="%s" gradientUnits="userSpaceOnUse" %s>'
        '<stop stop-color="%s"/><stop offset="1" stop-color="%s"/></linearGradient>'
    )
    return fills, [
        form % (one, place, begin, end)
        for (one, begin, end), place in zip(named, places, strict=True)
    ]
