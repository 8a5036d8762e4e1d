"""Triangles in their own colours, and paper cut along them."""

from typing import cast

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.svg.layers import Layer, ground_of
from stages.exchange.svg.merged import merged_outlines
from stages.exchange.svg.outlines import triangle_outlines
from stages.exchange.svg.text import elements, hexes, ids_of, path_data
from warp_kernels.styles import Style
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.paper import Paper

SHEETS = 16
"""Bits before those of the hash by which cuts of paper differ."""


def flat(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """One path for each triangle, or for neighbours of one colour."""
    return Layer(faces(figure, film, name, figure.colors), [])


def paper(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """Paper without a grain: one sheet, or cuts that differ a little."""
    sheet = cast(Paper, style)
    color = np.array(parse_color(sheet.color))
    if sheet.sheets == 0.0:
        shown = hexes(np.rint(color).astype(np.uint8)[None])[0]
        width, height = film.size
        return Layer([f'<rect width="{width}" height="{height}" fill="{shown}"/>'], [])
    chance = (figure.paint.hashes >> np.uint32(SHEETS) & np.uint32(255)) / 256.0
    brightness = 0.5 + sheet.sheets * (chance - 0.5)
    dark = np.minimum(2.0 * brightness, 1.0)[:, None] * color
    light = np.maximum(2.0 * brightness - 1.0, 0.0)[:, None]
    colors = np.rint(dark + light * (255.0 - dark)).astype(np.uint8)
    return Layer(faces(figure, film, name, colors), [])


def faces(figure: Figure, film: Film, name: str, colors: np.ndarray) -> list[str]:
    """Elements of all triangles in some colours, over a ground.

    Args:
        figure: The frame.
        film: What all frames have in common.
        name: Begin of the ids.
        colors: Code values, [T, 3] uint8.
    """
    mesh, precision = figure.mesh, film.options.svg_precision
    if film.options.svg_merge:
        merged = merged_outlines(mesh, colors)
        data = path_data(merged.outlines.points, merged.outlines.counts, precision)
        data = ["".join(data[a:b]) for a, b in merged.spans]
        triangles = merged.firsts
    else:
        outlines = triangle_outlines(mesh)
        data = path_data(outlines.points, outlines.counts, precision)
        triangles = np.arange(mesh.triangle_count)
    ids = ids_of(name, mesh.triangle_ids[triangles])
    shown = elements('<path id="%s" fill="%s" d="%s"/>', ids, hexes(colors[triangles]), data)
    return [ground_of(figure), *shown]
