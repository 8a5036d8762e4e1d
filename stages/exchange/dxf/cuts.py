"""What a cutter follows of each style."""

from collections.abc import Callable
from typing import cast

import numpy as np

from stages.exchange.dxf.sheet import Sheet
from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.plane.areas import areas_of
from stages.exchange.plane.discs import packed
from stages.exchange.plane.inks import inks_of
from stages.exchange.plane.shrunk import shrunk_of
from stages.exchange.plane.strokes import LINES, strokes_of
from stages.exchange.plane.trails import trails_of
from stages.exchange.plane.travel import short_way
from warp_kernels.styles import STYLES, Style
from warp_kernels.styles.circles import Circles
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.drawn import Drawn
from warp_kernels.styles.edges import Edges
from warp_kernels.styles.shrink import Shrink

Draws = Callable[[Style, Figure, Film, str, Sheet], None]
"""Lays a style on a sheet; the text is the begin of its layers' names."""


def edges(style: Style, figure: Figure, film: Film, name: str, sheet: Sheet) -> None:
    """Each edge once, in few long lines."""
    mesh, color = figure.mesh, np.rint(parse_color(cast(Edges, style).color)).astype(np.uint8)
    trails = trails_of(mesh.edge_vertices, mesh.vertices)
    pens = sheet.pens(name, np.tile(color, (len(trails), 1)))
    sheet.lines([mesh.vertices[trail] for trail in trails], pens)


def flat(style: Style, figure: Figure, film: Film, name: str, sheet: Sheet) -> None:
    """A closed line around each triangle, or around neighbours of one colour."""
    mesh, colors = figure.mesh, figure.colors
    if not film.options.svg_merge:
        order = short_way(mesh.corners.mean(axis=1))
        sheet.loops(list(mesh.corners[order]), sheet.pens(name, colors[order]))
        return
    areas = areas_of(mesh, colors)
    origins = mesh.triangles.reshape(-1)[areas.loops]
    loops = np.split(mesh.vertices[origins], np.cumsum(areas.counts)[:-1])
    _, firsts = np.unique(areas.shapes, return_index=True)
    sheet.loops(loops, sheet.pens(name, colors[firsts[areas.loop_shapes]]))


def shrink(style: Style, figure: Figure, film: Film, name: str, sheet: Sheet) -> None:
    """A closed line around what is left of each triangle."""
    own, mesh = cast(Shrink, style), figure.mesh
    order = short_way(mesh.corners.mean(axis=1))
    corners, pens = mesh.corners[order], sheet.pens(name, figure.colors[order])
    left = shrunk_of(own, corners)
    if own.rounding == 0.0:
        sheet.loops(list(left.inner), pens)
        return
    # a line turns around each corner by what is missing there to half a turn
    ahead = np.roll(corners, -1, axis=1) - corners
    turns = np.roll(ahead, -1, axis=1)
    cross = ahead[..., 0] * turns[..., 1] - ahead[..., 1] * turns[..., 0]
    angles = np.arctan2(cross, (ahead * turns).sum(axis=2))
    # y points up on the sheet, so that what turned to the right there turns to the left here
    bulges = np.stack([np.zeros_like(angles), -np.tan(angles / 4.0)], axis=2)
    sheet.loops(list(left.sides.reshape(-1, 6, 2)), pens, list(bulges.reshape(-1, 6)))


def circles(style: Style, figure: Figure, film: Film, name: str, sheet: Sheet) -> None:
    """A circle for each disc."""
    discs = packed(cast(Circles, style), figure.mesh.corners)
    order = short_way(discs.places)
    pens = sheet.pens(name, figure.colors[discs.triangles[order]])
    sheet.circles(discs.places[order], discs.radii[order], pens)


def strokes(style: Style, figure: Figure, film: Film, name: str, sheet: Sheet) -> None:
    """A line for each stroke, a layer a pen; paper is what is cut."""
    own = cast(Drawn, style)
    inks = inks_of(own, figure)
    found = strokes_of(own, figure, film, inks, LINES[STYLES.name_of(type(style))])
    order = short_way(figure.mesh.corners.mean(axis=1))
    ranks = np.empty(len(order), np.int64)
    ranks[order] = np.arange(len(order))
    rows = np.argsort(ranks[found.triangles], kind="stable")
    sheet.strokes(found.ends[rows], sheet.pens(name, inks.pens[found.triangles[rows]]))


CUTS: dict[str, Draws] = {
    "circles": circles,
    "crosshatching": strokes,
    "edges": edges,
    "flat": flat,
    "hatching": strokes,
    "shrink": shrink,
}
"""What lays each style on a sheet."""
