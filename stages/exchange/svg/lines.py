"""The edges of the triangles as strokes."""

from typing import cast

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.plane.trails import trails_of
from stages.exchange.svg.layers import Layer
from stages.exchange.svg.text import elements, filled, hexes, lines_of, open_lines, rounded
from warp_kernels.styles import Style
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.edges import Edges


def edges(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """Each edge once; in one path of few long lines, unless some are fainter than others."""
    own, mesh = cast(Edges, style), figure.mesh
    precision = film.options.svg_precision
    color = hexes(np.rint(parse_color(own.color)).astype(np.uint8)[None])[0]
    pen = f'fill="none" stroke="{color}" stroke-width="{own.width:.9g}" stroke-linecap="round"'
    if own.fade == 0.0:
        trails = trails_of(mesh.edge_vertices, mesh.vertices)
        counts = np.array([len(trail) for trail in trails])
        data = open_lines(mesh.vertices[np.concatenate(trails)], counts, precision)
        return Layer([f'<path {pen} stroke-linejoin="round" d="{"".join(data)}"/>'], [])
    ends = mesh.vertices[mesh.edge_vertices]
    data = filled(["M%.9g %.9gL%.9g %.9g"] * len(ends), rounded(ends, precision))
    sides = ends[:, 1] - ends[:, 0]
    share = np.minimum(np.hypot(sides[:, 0], sides[:, 1]) / own.fade, 1.0)
    strength = share * share * (3.0 - 2.0 * share)
    shown = elements('<path stroke-opacity="%s" d="%s"/>', lines_of("%.3g", strength), data)
    return Layer([f"<g {pen}>", *shown, "</g>"], [])
