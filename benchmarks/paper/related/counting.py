"""Delaunay meshes with a wanted number of triangles, whatever places their vertices."""

from collections.abc import Callable

import numpy as np
from scipy.spatial import Delaunay

from stages.mesh import Mesh, areas_of, mesh_of

SPARE = 0.02
"""Part of the vertices that may be too many; the last of them are left out."""
MARGIN = 0.5
"""Inner vertices keep this distance from the border [px]."""
ROUNDS = 16
"""Numbers of vertices that are tried."""
BORDER_SPACING = 1.5
"""Distance of the vertices along the border, in distances of an even spread [1]."""
JITTER = 1e-3
"""Vertices on the pixel raster are shifted by up to this [px]: four on a circle have no one
Delaunay triangulation."""


def mesh_of_count(
    place: Callable[[float], np.ndarray], triangle_count: int, size: tuple[int, int]
) -> Mesh:
    """Ask for more or fewer vertices until their Delaunay mesh has the wanted triangles.

    Args:
        place: Gives about as many inner vertices [px, N x 2] as it is asked for, those that can
            best be spared last.
        triangle_count: Wanted number of triangles.
        size: Width and height of the picture [px].
    """
    border = border_points(triangle_count, size)
    # every triangulation of I inner and B border vertices has 2 I + B - 2 triangles
    inner = max(1, (triangle_count + 2 - len(border)) // 2)
    points = _just_enough(lambda asked: _inside(place(asked), size), inner)
    return delaunay_mesh(np.concatenate([border, points[:inner]]), size)


def _just_enough(place: Callable[[float], np.ndarray], wanted: int) -> np.ndarray:
    """The fewest points that are enough, or the most where nothing is enough."""
    low, high, asked = 0.0, np.inf, float(wanted)
    best = np.zeros((0, 2))
    for _ in range(ROUNDS):
        points = place(asked)
        enough, better = len(points) >= wanted, len(points) < len(best)
        if better if enough and len(best) >= wanted else len(points) > len(best):
            best = points
        low, high = (low, asked) if enough else (asked, high)
        if wanted <= len(best) <= (1 + SPARE) * wanted:
            break
        asked *= (1 + 0.5 * SPARE) * wanted / max(1, len(points))
        if not low < asked < high:
            asked = 0.5 * (low + high) if np.isfinite(high) else 2.0 * low
    return best


def _inside(points: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """The points that keep off the border."""
    return points[((points > MARGIN) & (points < np.array(size) - MARGIN)).all(axis=1)]


def border_points(triangle_count: int, size: tuple[int, int]) -> np.ndarray:
    """The corners and vertices at even distances along the sides [px, B x 2]."""
    width, height = size
    spacing = BORDER_SPACING * np.sqrt(2.0 * width * height / triangle_count)
    x = np.linspace(0, width, max(1, round(width / spacing)) + 1)
    y = np.linspace(0, height, max(1, round(height / spacing)) + 1)[1:-1]
    sides = [(x, np.zeros_like(x)), (x, np.full_like(x, height))]
    sides += [(np.zeros_like(y), y), (np.full_like(y, width), y)]
    return np.concatenate([np.stack(side, axis=1) for side in sides])


def delaunay_mesh(points: np.ndarray, size: tuple[int, int]) -> Mesh:
    """The Delaunay mesh of points, of which the inner ones keep off the border.

    Args:
        points: Positions [px], [N, 2], with the corners of the picture among them.
        size: Width and height of the picture [px].
    """
    sides = np.array(size)
    on_border = points[((points == 0) | (points == sides)).any(axis=1)]
    points = np.unique(np.concatenate([on_border, _inside(points, size)]), axis=0)
    shift = np.random.default_rng(0).uniform(-JITTER, JITTER, points.shape)
    points = points + shift * ~((points == 0) | (points == sides)).any(axis=1)[:, None]
    triangles = Delaunay(points).simplices
    triangles = triangles[np.abs(areas_of(points[triangles])) > 1e-9]
    used, rows = np.unique(triangles, return_inverse=True)
    return mesh_of(points[used], rows.reshape(-1, 3), *size)
