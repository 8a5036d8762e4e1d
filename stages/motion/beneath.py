"""What lay where the new triangles of a mesh lie."""

import numpy as np

from stages.mesh import Mesh
from stages.motion.backtrack import earlier_vertices
from stages.motion.overlaps import overlaps

Shares = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Places among new triangles, numbers of known ones, and the part of each new one that the known
one has, [N] each."""


def beneath(
    before: Mesh, mesh: Mesh, born: np.ndarray, parts: int, among: np.ndarray | None = None
) -> Shares:
    """The triangles that lay where new ones lie, by the part of these that they cover.

    Args:
        before: The mesh of the neighbouring frame.
        mesh: The mesh with new triangles.
        born: Their numbers, [B].
        parts: Each is looked at in the middle of so many times so many equal parts.
        among: Triangles of `before` that may lie there, ascending; None for all.
    """
    corners = earlier_vertices(before, mesh)[mesh.triangles[born]]
    known = before.vertices[before.triangles if among is None else before.triangles[among]]
    spans, links = overlaps(corners, known)
    owners = np.repeat(np.arange(len(corners)), spans[:, 1] - spans[:, 0])
    shares = _inside(parts_of(corners, parts)[owners], known[links]).mean(axis=1)
    return owners, links if among is None else among[links], shares


def parts_of(corners: np.ndarray, parts: int) -> np.ndarray:
    """The middles of equal parts of triangles.

    Args:
        corners: Of the triangles [px], [N, 3, 2].
        parts: How many times so many.

    Returns:
        Points [px], [N, parts^2, 2].
    """
    first, second = np.mgrid[:parts, :parts].reshape(2, -1)
    upward = np.stack([first, second], axis=1)[first + second < parts] + 1 / 3
    downward = np.stack([first, second], axis=1)[first + second < parts - 1] + 2 / 3
    weights = np.concatenate([upward, downward]) / parts
    sides = corners[:, 1:] - corners[:, :1]
    points: np.ndarray = corners[:, :1] + weights @ sides
    return points


def _inside(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Whether points [N, P, 2] lie in triangles [N, 3, 2], one for each row, [N, P] bool."""
    inside = np.ones(points.shape[:2], dtype=bool)
    for corner in range(3):
        begin = corners[:, corner, None]
        side = corners[:, (corner + 1) % 3, None] - begin
        away = points - begin
        inside &= side[..., 0] * away[..., 1] - side[..., 1] * away[..., 0] >= 0.0
    return inside
