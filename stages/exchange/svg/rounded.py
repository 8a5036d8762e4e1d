"""Triangles drawn a little smaller, with round corners."""

from typing import cast

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.svg.layers import Layer
from stages.exchange.svg.text import elements, filled, hexes, ids_of, rounded
from warp_kernels.drawing.paint import shapes_of
from warp_kernels.styles import Style
from warp_kernels.styles.shrink import Shrink

_SHARP = "M%.9g %.9gL%.9g %.9g %.9g %.9gz"
_SIDE = "L%.9g %.9gA%.9g %.9g 0 0 1 %.9g %.9g"
_ROUND = "M%.9g %.9g" + 3 * _SIDE + "z"


def shrunk(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """What is left of each triangle: an inner one, and all that is not far from it."""
    own, mesh = cast(Shrink, style), figure.mesh
    corners, precision = mesh.corners, film.options.svg_precision
    incircles = shapes_of(corners).incircles
    radius = np.maximum(incircles[:, 2], 1e-3)
    centres = corners[:, 0] + incircles[:, :2]
    left = np.maximum(radius - 0.5 * own.gap, own.smallest * radius)
    around = own.rounding * left
    size = ((left - around) / radius)[:, None, None]
    inner = centres[:, None] + size * (corners - centres[:, None])
    if own.rounding == 0.0:
        data = filled([_SHARP] * len(inner), rounded(inner, precision))
    else:
        data = _round(inner, corners, around, precision)
    ids = ids_of(name, mesh.triangle_ids)
    shown = elements('<path id="%s" fill="%s" d="%s"/>', ids, hexes(figure.colors), data)
    return Layer(shown, [])


def _round(inner: np.ndarray, corners: np.ndarray, around: np.ndarray, precision: int) -> list[str]:
    """Path data of all that is as near to inner triangles.

    Args:
        inner: Their corners [px], [T, 3, 2].
        corners: Those of the whole ones, whose sides have the same directions [px], [T, 3, 2].
        around: How near [px], [T].
        precision: Decimals.
    """
    sides = np.roll(corners, -1, axis=1) - corners
    lengths = np.maximum(np.hypot(sides[..., 0], sides[..., 1]), 1e-9)
    # away from a triangle that lies to the right of its sides
    outwards = np.stack([sides[..., 1], -sides[..., 0]], axis=2) / lengths[..., None]
    outwards *= around[:, None, None]
    begins, ends = inner + outwards, np.roll(inner, -1, axis=1) + outwards
    radii = np.broadcast_to(around[:, None, None], (*begins.shape[:2], 2))
    pieces = np.concatenate([ends, radii, np.roll(begins, -1, axis=1)], axis=2)
    numbers = np.concatenate([begins[:, 0], pieces.reshape(len(inner), -1)], axis=1)
    return filled([_ROUND] * len(inner), rounded(numbers, precision))
