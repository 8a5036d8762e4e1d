"""Discs packed into triangles."""

from dataclasses import dataclass

import numpy as np

from warp_kernels.drawing.paint import shapes_of
from warp_kernels.styles.circles import Circles

MOST = 400
"""Discs of a chain into a corner, at most: the least factor between two neighbours is 0.0005."""


@dataclass(frozen=True, eq=False)
class Discs:
    """Discs, triangle by triangle."""

    triangles: np.ndarray
    """The triangle that each lies in, ascending, [N]."""
    places: np.ndarray
    """Centres [px], [N, 2]."""
    radii: np.ndarray
    """Above 0 [px], [N]."""


def packed(style: Circles, corners: np.ndarray) -> Discs:
    """The incircle, and from it a chain of ever smaller discs into each corner.

    Args:
        style: Says how small they become, and how far apart they lie.
        corners: Those of triangles [px], [T, 3, 2].
    """
    incircles = shapes_of(corners).incircles
    radius = np.maximum(incircles[:, 2], 1e-3)
    centres = corners[:, 0] + incircles[:, :2]
    found = [(np.arange(len(radius)), centres, radius)]
    for corner in range(3):
        away = corners[:, corner] - centres
        reach = np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-6)
        sine = np.minimum(radius / reach, 0.999)
        factor, size = (1.0 - sine) / (1.0 + sine), np.ones_like(sine)
        for _ in range(MOST):
            size = size * factor
            kept = np.flatnonzero(radius * size >= style.smallest)
            if len(kept) == 0:
                break
            places = centres[kept] + (1.0 - size[kept])[:, None] * away[kept]
            found.append((kept, places, radius[kept] * size[kept]))
    triangles, places, radii = (np.concatenate(part) for part in zip(*found, strict=True))
    radii = radii - 0.5 * style.gap
    order = np.argsort(triangles, kind="stable")
    order = order[radii[order] > 0.0]
    return Discs(triangles[order], places[order], radii[order])
