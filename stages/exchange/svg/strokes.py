"""Hatching as strokes of pens: lines of one width, as near to each other as the tone asks for."""

from typing import cast

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.svg.faces import faces
from stages.exchange.svg.hatch import Segments, hatched
from stages.exchange.svg.inks import Inks, inks_of
from stages.exchange.svg.layers import Layer, sheet_of
from stages.exchange.svg.text import elements, filled, hexes, ids_of, rounded
from stages.exchange.svg.tones import drawn_ink, seen_tones
from stages.exchange.svg.travel import short_way
from warp_kernels.scene.stroke_lay import own_lay
from warp_kernels.styles import Style
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.drawn import NO_PAPER, OWN_PAPER, Drawn
from warp_kernels.styles.tones.ruling import ACROSS, FALLING, RISING, SLANTED, Direction

PENS = 32
"""So many colours at most have a layer each."""
DENSEST = 0.3
"""Part of the paper that lines of one direction cover before others cross them."""
SHIFTS = (0.0, 0.5, 0.25, 0.75)
"""How far lines of each direction lie aside [distances]: they cross all over small triangles."""


def hatching(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """Lines along the base edge of each triangle."""
    return _drawn(cast(Drawn, style), figure, film, name, (ACROSS,))


def crosshatching(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """The same, crossed by others the darker it is."""
    return _drawn(cast(Drawn, style), figure, film, name, (ACROSS, FALLING, RISING, SLANTED))


def _drawn(
    style: Drawn, figure: Figure, film: Film, name: str, directions: tuple[Direction, ...]
) -> Layer:
    """Strokes in these directions, on their paper if there is any."""
    inks = inks_of(style, figure)
    strokes = _strokes(style, figure, film, inks, directions)
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


def _strokes(
    style: Drawn, figure: Figure, film: Film, inks: Inks, directions: tuple[Direction, ...]
) -> Segments:
    """The strokes of every triangle."""
    pixel, is_paper = 1.0 / film.scale[0], film.options.svg_mm > 0.0
    mesh = figure.mesh
    lay = figure.paint.lay or own_lay(mesh.triangle_ids, mesh.corners)
    ink = drawn_ink(style, mesh.corners, lay, inks.amounts, pixel)
    tones = ink.mean(axis=1) if is_paper else seen_tones(ink, inks)
    # what lines that know nothing of each other leave blank is a product: its logarithm is shared
    depths, most = -np.log1p(-np.minimum(tones, 0.99)), -np.log1p(-DENSEST)
    shares = np.clip(depths - most * np.arange(len(directions))[:, None], 0.0, most)
    shares = np.maximum(shares, (depths > most * len(directions)) * depths / len(directions))
    parts = []
    for direction, shift, share in zip(directions, SHIFTS, shares, strict=False):
        slant = np.arctan2(1.0, direction.slope) if direction.steep else np.arctan(direction.slope)
        covered = -np.expm1(-share)
        width = style.weight * style.spacing
        turn = style.angle + np.degrees(slant)
        parts.append(hatched(mesh.corners, lay, turn, shift, covered, width))
    triangles = np.concatenate([part.triangles for part in parts])
    order = np.argsort(triangles, kind="stable")
    return Segments(triangles[order], np.concatenate([part.ends for part in parts])[order])


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
