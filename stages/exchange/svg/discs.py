"""Discs in the triangles: packed ones, and soft ones in their incircles."""

from typing import cast

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.plane.discs import packed
from stages.exchange.svg.layers import Layer
from stages.exchange.svg.text import elements, hexes, ids_of, lines_of, path_data, rounded
from warp_kernels.drawing.paint import shapes_of
from warp_kernels.styles import Style
from warp_kernels.styles.circles import Circles
from warp_kernels.styles.incircles import Incircles

STOPS = 12
"""Straight pieces by which the fall of opacity towards a rim is written: off by 0.5 % at most."""


def circles(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """The incircle, and from it a chain of ever smaller discs into each corner."""
    discs = packed(cast(Circles, style), figure.mesh.corners)
    numbers = rounded(np.column_stack([discs.places, discs.radii]), film.options.svg_precision)
    shown = hexes(figure.colors)
    fills = [shown[triangle] for triangle in discs.triangles.tolist()]
    rows = lines_of('cx="%.9g" cy="%.9g" r="%.9g"', numbers)
    return Layer(elements('<circle %s fill="%s"/>', rows, fills), [])


def incircles(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """Discs that fade towards their rims; those larger than the incircle end with the triangle."""
    own, mesh = cast(Incircles, style), figure.mesh
    precision, ids = film.options.svg_precision, ids_of(name, mesh.triangle_ids)
    shapes = shapes_of(mesh.corners).incircles
    radii = np.maximum(shapes[:, 2], 1e-3) * own.size
    numbers = rounded(np.column_stack([mesh.corners[:, 0] + shapes[:, :2], radii]), precision)
    colors = hexes(figure.colors)
    rows = lines_of('cx="%.9g" cy="%.9g" r="%.9g"', numbers)
    if own.softness == 0.0 and own.size <= 1.0:
        return Layer(elements('<circle id="%s" %s fill="%s"/>', ids, rows, colors), [])
    fades = _stops(max(own.softness, 1e-3))
    begun = '<radialGradient id="%s-fill" gradientUnits="userSpaceOnUse" %s>%s</radialGradient>'
    definitions = elements(begun, ids, rows, [fades.replace("COLOR", one) for one in colors])
    fills = [f"url(#{one}-fill)" for one in ids]
    if own.size <= 1.0:
        shown = elements('<circle id="%s" %s fill="%s"/>', ids, rows, fills)
    else:
        counts = np.full(mesh.triangle_count, 3)
        data = path_data(mesh.corners.reshape(-1, 2), counts, precision)
        shown = elements('<path id="%s" d="%s" fill="%s"/>', ids, data, fills)
    return Layer(shown, definitions)


def _stops(softness: float) -> str:
    """How opacity falls towards the rim, with a place for the colour."""
    share = np.arange(STOPS + 1) / STOPS
    opacity = 1.0 - share * share * (3.0 - 2.0 * share)
    places = 1.0 - softness + softness * share
    form = '<stop offset="%.4g" stop-color="COLOR" stop-opacity="%.4g"/>'
    return "".join(lines_of(form, places, opacity))
