"""Triangles a little smaller, with round corners."""

from dataclasses import dataclass

import numpy as np

from warp_kernels.drawing.paint import shapes_of
from warp_kernels.styles.shrink import Shrink


@dataclass(frozen=True, eq=False)
class Shrunk:
    """What is left of each triangle: an inner one, and all that is not far from it."""

    inner: np.ndarray
    """Corners of the inner triangles [px], [T, 3, 2]."""
    around: np.ndarray
    """How far it reaches around them [px], [T]."""
    sides: np.ndarray
    """Begin and end of the straight parts of its border, [T, 3, 2, 2]: between them are arcs."""


def shrunk_of(style: Shrink, corners: np.ndarray) -> Shrunk:
    """Shrink triangles.

    Args:
        style: Says by how much, and how round they become.
        corners: Theirs [px], [T, 3, 2].
    """
    incircles = shapes_of(corners).incircles
    radius = np.maximum(incircles[:, 2], 1e-3)
    centres = corners[:, 0] + incircles[:, :2]
    left = np.maximum(radius - 0.5 * style.gap, style.smallest * radius)
    around = style.rounding * left
    size = ((left - around) / radius)[:, None, None]
    inner = centres[:, None] + size * (corners - centres[:, None])
    sides = np.roll(corners, -1, axis=1) - corners
    lengths = np.maximum(np.hypot(sides[..., 0], sides[..., 1]), 1e-9)
    # away from a triangle that lies to the right of its sides
    outwards = np.stack([sides[..., 1], -sides[..., 0]], axis=2) / lengths[..., None]
    outwards *= around[:, None, None]
    begins, ends = inner + outwards, np.roll(inner, -1, axis=1) + outwards
    return Shrunk(inner, around, np.stack([begins, ends], axis=2))
