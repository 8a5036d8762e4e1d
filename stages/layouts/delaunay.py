"""Delaunay triangles of vertices in a rectangle, and vertices that are too near to each other.

SciPy has both, but takes longer to import than a picture of 700 triangles takes to begin with.
"""

import numpy as np

from stages.edits.legalise import legalise
from stages.mesh import Mesh, areas_of, mesh_of

THINNEST = 1e-9
"""A vertex that would make a triangle of less area [px^2] is left out: it lies on a line between
two others, as far as can be told."""


def delaunay_mesh(border: np.ndarray, inner: np.ndarray, width: int, height: int) -> Mesh:
    """The Delaunay triangulation of vertices in a rectangle.

    The two halves of the rectangle are divided by one vertex in each triangle at a time, until all
    have found a place, then along the border; edges are flipped in the end.

    Args:
        border: Vertices on the border [px], the corners among them, shape [B, 2].
        inner: Vertices inside [px], shape [N, 2].
        width: Width of the rectangle [px].
        height: Height of the rectangle [px].
    """
    points = np.concatenate([border, inner])
    sides = _sides(border, width, height)
    top, bottom = sides[0], sides[1]
    halves = np.array([[top[0], top[-1], bottom[0]], [bottom[-1], bottom[0], top[-1]]])
    rows = _divided(points, halves, np.arange(len(border), len(points)))
    for chain in sides:
        rows = _divided_side(rows, chain)
    used, numbers = np.unique(rows, return_inverse=True)
    return legalise(mesh_of(points[used], numbers.reshape(rows.shape), width, height))


def _sides(border: np.ndarray, width: int, height: int) -> list[np.ndarray]:
    """Vertices along the four sides, from the left to the right or from the top to the bottom."""
    sides = []
    for axis, place in ((1, 0), (1, height), (0, 0), (0, width)):
        found = np.flatnonzero(border[:, axis] == place)
        sides.append(found[np.argsort(border[found, 1 - axis])])
    return sides


def _divided(points: np.ndarray, rows: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """Divide triangles by the vertices in them, each into three.

    Args:
        points: Positions [px], shape [V, 2].
        rows: Two triangles of positive area that share the edge from row 0's corner 2 to its
            corner 1, shape [2, 3].
        numbers: The vertices to put into them, shape [N].

    Returns:
        Shape [2 + 2 N or less, 3].
    """
    beyond = _turn(points, np.full(len(numbers), rows[0, 2]), rows[0, 1], numbers) > 0
    places = beyond.astype(np.int64)
    while len(numbers):
        parents, first = np.unique(places, return_index=True)
        centres = numbers[first]
        corners = rows[parents]
        parts = np.stack(
            [np.stack([corners[:, k], corners[:, k - 2], centres], axis=1) for k in range(3)]
        )
        whole = (areas_of(points[parts.reshape(-1, 3)]).reshape(3, -1) > THINNEST).all(axis=0)
        # of each parent the triangle that takes its row, and the two that are new
        children = np.stack([parents, parents, parents])
        children[1:, whole] = len(rows) + np.arange(2 * whole.sum()).reshape(2, -1)
        rows = np.concatenate([rows, parts[1, whole], parts[2, whole]])
        rows[parents[whole]] = parts[0, whole]
        owners = np.searchsorted(parents, places)
        waits = np.ones(len(numbers), dtype=bool)
        waits[first] = False
        numbers, owners = numbers[waits], owners[waits]
        centre = centres[owners]
        after = np.stack(
            [_turn(points, centre, corners[owners, k], numbers) >= 0 for k in range(3)]
        )
        # between the rays to two corners, one after the other
        part = np.where(after[0] & ~after[1], 0, np.where(after[1] & ~after[2], 1, 2))
        places = children[part, owners]
    return rows


def _turn(points: np.ndarray, origin: np.ndarray, along: np.ndarray, to: np.ndarray) -> np.ndarray:
    """On which side of lines from one vertex to another a third one lies [px^2], shape [N]."""
    first, second = points[along] - points[origin], points[to] - points[origin]
    turn: np.ndarray = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    return turn


def _divided_side(rows: np.ndarray, chain: np.ndarray) -> np.ndarray:
    """Divide the one triangle at a side of the rectangle by the vertices along that side.

    Args:
        rows: Triangles, shape [T, 3].
        chain: Vertices of the side from corner to corner, shape [2 or more].
    """
    ends = (rows[..., None] == chain[[0, -1]]).any(axis=1).all(axis=1)
    (row,) = np.flatnonzero(ends)
    apex = rows[row][~np.isin(rows[row], chain[[0, -1]])]
    fan = np.stack([chain[:-1], chain[1:], np.repeat(apex, len(chain) - 1)], axis=1)
    return np.concatenate([np.delete(rows, row, axis=0), fan])


def apart_from(points: np.ndarray, others: np.ndarray, spacing: float) -> np.ndarray:
    """Which points keep a distance from all others.

    Args:
        points: Positions [px], shape [N, 2].
        others: Positions [px], shape [M, 2].
        spacing: The distance [px].

    Returns:
        Shape [N] bool.
    """
    found, _ = _near_pairs(points, others, spacing, touching=False)
    apart = np.ones(len(points), dtype=bool)
    apart[found] = False
    return apart


def earlier_ones(points: np.ndarray, spacing: float) -> np.ndarray:
    """Which points have no earlier one within a distance.

    Args:
        points: Positions [px], shape [N, 2].
        spacing: The distance [px].

    Returns:
        Shape [N] bool.
    """
    one, other = _near_pairs(points, points, spacing, touching=True)
    first = np.ones(len(points), dtype=bool)
    first[one[one > other]] = False
    return first


def _near_pairs(
    points: np.ndarray, others: np.ndarray, spacing: float, *, touching: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of points nearer than a distance, or as near; their numbers in both lists.

    Both are sorted into square cells of that size: what is near lies in the same or in the next.
    """
    cells, other_cells = ((p // spacing).astype(np.int64) + 1 for p in (points, others))
    columns = 2 + int(max(cells[:, 0].max(initial=0), other_cells[:, 0].max(initial=0)))
    keys = other_cells[:, 1] * columns + other_cells[:, 0]
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    ones, twos = [], []
    for down in (-1, 0, 1):
        # three cells side by side are one stretch of the sorted keys
        middle = (cells[:, 1] + down) * columns + cells[:, 0]
        begin = np.searchsorted(keys, middle - 1, side="left")
        counts = np.searchsorted(keys, middle + 1, side="right") - begin
        one = np.repeat(np.arange(len(points)), counts)
        shift = np.repeat(begin - (np.cumsum(counts) - counts), counts)
        two = order[np.arange(len(one)) + shift]
        away = np.sqrt(((points[one] - others[two]) ** 2).sum(axis=1))
        near = away <= spacing if touching else away < spacing
        ones.append(one[near])
        twos.append(two[near])
    return np.concatenate(ones), np.concatenate(twos)
