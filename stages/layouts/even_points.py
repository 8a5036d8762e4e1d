"""What layouts of even points share: a border, a spacing that meets a number, triangles."""

from collections.abc import Callable

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from stages.mesh import Mesh, areas_of, mesh_of

APPROACHES = 5
"""Spacings that are tried on the way to the number of triangles."""
SPREAD, TRIALS = 1.04, 11
"""Then so many around the last one, up to so many times larger and smaller."""
MARGIN = 0.45
"""Inner points keep this part of the spacing from the border."""
CLOSEST = 0.5
"""Points never come closer than this [px]."""

PointsOf = Callable[[float], np.ndarray]
"""Inner points of a picture at a spacing [px], [N, 2], and maybe some beside the picture."""


def bounded_count(pixels: np.ndarray, triangle_count: int) -> int:
    """How many triangles a picture can have: two or more, and no more than pixels."""
    height, width = pixels.shape[:2]
    return max(2, min(triangle_count, width * height))


def fitted_mesh(pixels: np.ndarray, triangle_count: int, points_of: PointsOf) -> Mesh:
    """Triangulate the pattern at the spacing that comes nearest to a number of triangles.

    Args:
        pixels: The picture, [H, W, 3] uint8; only its size matters.
        triangle_count: Wanted number of triangles.
        points_of: The pattern.
    """
    height, width = pixels.shape[:2]
    count = bounded_count(pixels, triangle_count)
    spacing = even_spacing(width, height, count)
    best: tuple[int, np.ndarray] | None = None
    around = SPREAD ** np.linspace(-1.0, 1.0, TRIALS)
    for trial in range(APPROACHES + TRIALS):
        tried = spacing if trial < APPROACHES else float(spacing * around[trial - APPROACHES])
        points = with_border(points_of(tried), width, height, tried)
        found = _triangles_over(points, width, height)
        if best is None or abs(found - count) < best[0]:
            best = abs(found - count), points
        if found == count:
            break
        if trial < APPROACHES:
            spacing *= float(np.clip(np.sqrt(found / count), 0.5, 2.0))
    assert best is not None
    return delaunay_mesh(best[1], width, height)


def even_spacing(width: int, height: int, count: int) -> float:
    """Side of equal triangles of which so many fill a picture [px]."""
    return float(np.sqrt(4.0 / np.sqrt(3.0) * width * height / count))


def border_points(width: int, height: int, spacing: float) -> np.ndarray:
    """The corners, and points along the sides about `spacing` apart [px], [B, 2]."""
    across, down = (max(1, round(side / spacing)) for side in (width, height))
    x, y = np.linspace(0, width, across + 1), np.linspace(0, height, down + 1)
    top = np.stack([x, np.zeros_like(x)], axis=1)
    left = np.stack([np.zeros(down - 1), y[1:-1]], axis=1)
    right, bottom = left + np.array([width, 0]), top + np.array([0, height])
    return np.concatenate([top, bottom, left, right])


def with_border(inner: np.ndarray, width: int, height: int, spacing: float) -> np.ndarray:
    """Points of the border, then those inner ones that keep away from it and lie in the picture.

    Args:
        inner: Points [px], [N, 2].
        width: Of the picture [px].
        height: Of the picture [px].
        spacing: Distance of the points [px].
    """
    margin = MARGIN * min(spacing, 0.5 * min(width, height))
    size = np.array([width, height])
    lies_in = ((inner > margin) & (inner < size - margin)).all(axis=1)
    return np.concatenate([border_points(width, height, spacing), inner[lies_in]])


def _triangles_over(points: np.ndarray, width: int, height: int) -> int:
    """Triangles over points: I inner and B border ones make 2 I + B - 2."""
    on_border = ((points == 0) | (points == (width, height))).any(axis=1)
    return int(2 * (~on_border).sum() + on_border.sum() - 2)


def apart(points: np.ndarray, distance: float, fixed: int = 0) -> np.ndarray:
    """Points that keep a distance from each other: of two close ones the later goes, [M, 2].

    Args:
        points: Points [px], [N, 2], in the order of their worth.
        distance: What they keep [px].
        fixed: So many of the first stay in any case.
    """
    stays = np.ones(len(points), dtype=bool)
    open_ = np.arange(len(points))
    chosen = np.zeros(len(points), dtype=bool)
    while len(open_):  # the first of all around it is in; those around it are out
        pairs = cKDTree(points[open_]).query_pairs(distance, output_type="ndarray")
        later = np.ones(len(open_), dtype=bool)
        later[pairs.max(axis=1)] = False
        later |= open_ < fixed
        first = np.flatnonzero(later)
        chosen[open_[first]] = True
        near = pairs[later[pairs].any(axis=1)]
        beaten = np.unique(near[~later[near]])
        stays[open_[beaten]] = False
        gone = later.copy()
        gone[beaten] = True
        open_ = open_[~gone]
    return points[stays & chosen]


def delaunay_mesh(points: np.ndarray, width: int, height: int) -> Mesh:
    """Delaunay triangles of points in a picture, its corners among them.

    Args:
        points: Points [px], [N, 2]; those that are the same but for a little become one.
        width: Of the picture [px].
        height: Of the picture [px].
    """
    points = apart(points, min(CLOSEST, 0.2 * min(width, height)), fixed=4)
    triangles = Delaunay(points).simplices
    triangles = triangles[areas_of(points[triangles]) != 0]
    used, numbers = np.unique(triangles, return_inverse=True)
    return mesh_of(points[used], numbers.reshape(-1, 3), width, height)
