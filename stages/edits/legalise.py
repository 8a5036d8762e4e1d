"""Restore the Delaunay property by edge flips."""

from dataclasses import replace

import numpy as np

from stages.edits.flip_edges import flip_in_place
from stages.mesh import Mesh, next_corner, previous_corner

ANGLE_TOLERANCE = 1e-12
"""Sines below this count as 0 [rad]: far above the rounding of float64, about 1e-15.

Every flip then truly lowers the triangulation lifted to the paraboloid, so none comes back and
the flips end, on four points of one circle as well.
"""


def legalise(mesh: Mesh, where: np.ndarray | None = None) -> Mesh:
    """Flip edges until the angles opposite to every edge add up to at most 180 degrees.

    Flips run in batches that do not touch each other, with local updates of the tables. The
    result is the Delaunay triangulation of the vertices (one of them, where four lie on a
    circle). Flipped triangles go on as in `flip_edges`.

    Args:
        mesh: The mesh to edit.
        where: Triangles whose edges are suspect, shape [T] bool; the Delaunay property then
            spreads from there. Else all.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.4.
    """
    points = mesh.vertices.view(np.complex128).reshape(-1)
    triangles, twins = mesh.triangles.copy(), mesh.twins.copy()
    suspects = mesh.edge_half_edges.astype(np.int64)
    suspects = suspects[twins[suspects] >= 0]
    if where is not None:
        suspects = suspects[where[suspects // 3] | where[twins[suspects] // 3]]
    while True:
        illegal = suspects[_illegal(points, triangles.reshape(-1), twins, suspects)]
        if not len(illegal):
            break
        pairs = np.stack([illegal // 3, twins[illegal] // 3], axis=1)
        chosen, touched = _separate(pairs, mesh.triangle_count)
        outline = flip_in_place(mesh.vertices, triangles, twins, illegal[chosen])
        suspects = np.concatenate([illegal[~touched], outline[twins[outline] >= 0]])
    if np.array_equal(triangles, mesh.triangles):
        return mesh
    return replace(mesh, triangles=triangles).with_twins(twins)


def _illegal(
    points: np.ndarray, corners: np.ndarray, twins: np.ndarray, half_edges: np.ndarray
) -> np.ndarray:
    """Which inner edges are to be flipped.

    Args:
        points: Positions x + i y [px], shape [V] complex.
        corners: Vertex of every half-edge's origin, shape [3T].
        twins: Twin table, shape [3T].
        half_edges: Numbers of inner half-edges, shape [N].

    Returns:
        Shape [N] bool.
    """
    a, b = points[corners[half_edges]], points[corners[next_corner(half_edges)]]
    c = points[corners[previous_corner(half_edges)]]
    d = points[corners[previous_corner(twins[half_edges])]]
    # The argument of conj(p) q is the angle from p to q: the product turns by both angles.
    at_c, at_d = (a - c).conj() * (b - c), (b - d).conj() * (a - d)
    turn = at_c * at_d
    illegal = turn.imag < -ANGLE_TOLERANCE * np.abs(turn)
    # In exact arithmetic such a pair is convex; rounding must not make a triangle without area.
    at_a, at_b = (d - a).conj() * (c - a), (c - b).conj() * (d - b)
    illegal &= at_a.imag > ANGLE_TOLERANCE * np.abs(at_a)
    illegal &= at_b.imag > ANGLE_TOLERANCE * np.abs(at_b)
    return illegal


def _separate(pairs: np.ndarray, triangle_count: int) -> tuple[np.ndarray, np.ndarray]:
    """Choose pairs of triangles that do not overlap, at least one of them.

    One round of a greedy choice: what it leaves is still there for the next batch.

    Args:
        pairs: Triangle numbers, shape [N, 2].
        triangle_count: Number of triangles.

    Returns:
        The pairs chosen [N] bool, and those that share a triangle with a chosen one [N] bool.
    """
    numbers = np.arange(len(pairs))[:, None]
    owner = np.empty(triangle_count, dtype=np.int64)
    owner[pairs] = numbers  # of equal places the last write stays, so the last pair wins
    chosen = (owner[pairs] == numbers).all(axis=1)
    taken = np.zeros(triangle_count, dtype=bool)
    taken[pairs[chosen]] = True
    return chosen, taken[pairs].any(axis=1)
