"""Trapped of shapes that are drawn one over the other and show no seam between them.

Renderers smooth the border of every path on its own. Where two paths meet, each covers a part of
the pixel, and together they leave some of it open: what lies below shines through as a hairline. So
a path goes on, as a strip, below its neighbours that are drawn later: these then mix with it, and
with nothing else. It keeps off those that were drawn before, beside which it would show.

Source: the practice of trapping in print. Measured in `benchmarks/vector_exact.py`, and there too:
    strips across needles, around vertices, and another order of drawing gain nothing that counts.
"""

from dataclasses import dataclass

import numpy as np

from stages.mesh import Mesh, next_corner, previous_corner

STRIP = 1.5
"""Width of a strip [px of the picture]: more than a pixel has from corner to corner."""


@dataclass(frozen=True, eq=False)
class Trapped:
    """Closed lines, one after the other."""

    points: np.ndarray
    """Corners [px of the picture], [P, 2]."""
    counts: np.ndarray
    """Corners of every line, [L]."""


def outlines_of(mesh: Mesh, loops: np.ndarray, counts: np.ndarray, shapes: np.ndarray) -> Trapped:
    """Trapped that go on below the shapes that are drawn later: those with a higher number.

    Args:
        mesh: The triangles.
        loops: Half-edges along the borders of shapes, loop by loop, [N].
        counts: Half-edges of every loop, [L].
        shapes: The shape that each triangle belongs to, in the order of drawing, [T].
    """
    line = np.repeat(np.arange(len(counts)), counts)
    owners = shapes[loops // 3]
    entered = mesh.twins[loops]
    is_under = (entered >= 0) & (shapes[entered // 3] > owners)
    corners = _strips(mesh, loops, np.where(is_under, entered, 0), owners, shapes)
    is_kept = np.stack([np.ones_like(is_under), is_under, is_under], axis=1)
    sizes = np.bincount(line, weights=is_kept.sum(axis=1), minlength=len(counts))
    return Trapped(corners[is_kept], sizes.astype(np.int64))


def triangle_outlines(mesh: Mesh) -> Trapped:
    """Trapped of all triangles, each drawn in its turn.

    Args:
        mesh: The triangles.
    """
    count = mesh.triangle_count
    return outlines_of(mesh, np.arange(3 * count), np.full(count, 3), np.arange(count))


def _strips(
    mesh: Mesh, edges: np.ndarray, entered: np.ndarray, owners: np.ndarray, shapes: np.ndarray
) -> np.ndarray:
    """Where each border begins, and the strip behind it, [N, 3, 2].

    Args:
        mesh: The triangles.
        edges: Half-edges along borders, [N].
        entered: Those of the neighbours, [N].
        owners: The shape of each, [N].
        shapes: That of each triangle, [T].
    """
    origins = mesh.triangles.reshape(-1)
    begins, ends = mesh.vertices[origins[edges]], mesh.vertices[origins[next_corner(edges)]]
    sides = next_corner(entered), previous_corner(entered)  # beside the begin, beside the end
    thirds = mesh.vertices[origins[sides[1]]]
    heights = _heights(mesh)
    depth = STRIP / heights[entered]
    away = [STRIP / heights[side] * _is_earlier(mesh, side, owners, shapes) for side in sides]
    whole = np.maximum(1.0, depth + away[0] + away[1])
    depth, at_begin, at_end = ((part / whole)[:, None] for part in (depth, *away))
    first = begins + depth * (thirds - begins) + at_begin * (ends - begins)
    last = ends + depth * (thirds - ends) + at_end * (begins - ends)
    return np.stack([begins, first, last], axis=1)


def _is_earlier(
    mesh: Mesh, sides: np.ndarray, owners: np.ndarray, shapes: np.ndarray
) -> np.ndarray:
    """Whether what lies behind sides was drawn before the owners, [N] bool."""
    behind = mesh.twins[sides]
    return np.asarray((behind >= 0) & (shapes[behind // 3] < owners))


def _heights(mesh: Mesh) -> np.ndarray:
    """Height of its triangle over every half-edge [px], [3T]."""
    corners = mesh.corners
    sides = np.roll(corners, -1, axis=1) - corners
    lengths = np.hypot(sides[..., 0], sides[..., 1])
    return np.maximum(2.0 * mesh.areas[:, None] / lengths, 1e-9).reshape(-1)
