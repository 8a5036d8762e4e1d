"""Triangles drawn a little smaller, with round corners."""

from typing import cast

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.plane.shrunk import Shrunk, shrunk_of
from stages.exchange.svg.layers import Layer
from stages.exchange.svg.text import elements, filled, hexes, ids_of, rounded
from warp_kernels.styles import Style
from warp_kernels.styles.shrink import Shrink

_SHARP = "M%.9g %.9gL%.9g %.9g %.9g %.9gz"
_SIDE = "L%.9g %.9gA%.9g %.9g 0 0 1 %.9g %.9g"
_ROUND = "M%.9g %.9g" + 3 * _SIDE + "z"


def shrunk(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """What is left of each triangle: an inner one, and all that is not far from it."""
    own, mesh = cast(Shrink, style), figure.mesh
    left, precision = shrunk_of(own, mesh.corners), film.options.svg_precision
    if own.rounding == 0.0:
        data = filled([_SHARP] * len(left.inner), rounded(left.inner, precision))
    else:
        data = _round(left, precision)
    ids = ids_of(name, mesh.triangle_ids)
    shown = elements('<path id="%s" fill="%s" d="%s"/>', ids, hexes(figure.colors), data)
    return Layer(shown, [])


def _round(left: Shrunk, precision: int) -> list[str]:
    """Path data of straight parts with arcs between them."""
    begins, ends = left.sides[:, :, 0], left.sides[:, :, 1]
    radii = np.broadcast_to(left.around[:, None, None], (*begins.shape[:2], 2))
    pieces = np.concatenate([ends, radii, np.roll(begins, -1, axis=1)], axis=2)
    numbers = np.concatenate([begins[:, 0], pieces.reshape(len(begins), -1)], axis=1)
    return filled([_ROUND] * len(begins), rounded(numbers, precision))
