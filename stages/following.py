"""Which triangles belong to a region: those under a mask in one frame, from there their heirs."""

import numpy as np

from stages.correspond import kept_triangles
from stages.earlier import earlier_vertices
from stages.mesh import Mesh
from stages.overlaps import overlaps

PARTS = 8
"""A triangle is looked at in the middle of so many times so many equal parts."""
HALF = 127.5
"""A mask is white above this [code value]."""


def under_mask(mesh: Mesh, mask: np.ndarray) -> np.ndarray:
    """The triangles most of which lies under the white of a mask.

    Args:
        mesh: The triangles.
        mask: Of the picture's size, [H, W] uint8.

    Returns:
        Whether each does, [T] bool.
    """
    points = _points(mesh.vertices[mesh.triangles])
    columns, rows = (
        np.clip(points[..., axis].astype(int), 0, mask.shape[1 - axis] - 1) for axis in (0, 1)
    )
    return (mask[rows, columns] > HALF).mean(axis=1) > 0.5


def inherited(before: Mesh, mesh: Mesh, members: np.ndarray) -> np.ndarray:
    """Carry regions on to a neighbouring frame of a shot, the next one or the one before.

    Triangles that both have keep what they were. A new one belongs where most of it lay.

    Args:
        before: The mesh whose triangles are known.
        mesh: The mesh of the neighbouring frame.
        members: Whether the triangles of `before` belong to each region, [T, R] bool.

    Returns:
        The same of `mesh`; `members` itself if no triangle came or went.
    """
    kept = kept_triangles(before, mesh)
    if np.array_equal(kept, np.arange(before.triangle_count)):
        return members
    born = np.flatnonzero(kept < 0)
    found = members[kept]
    found[born] = _most(before, earlier_vertices(before, mesh)[mesh.triangles[born]], members)
    return found


def _most(before: Mesh, corners: np.ndarray, members: np.ndarray) -> np.ndarray:
    """What most of some triangles [N, 3, 2] belongs to, [N, R]."""
    known = before.vertices[before.triangles]
    spans, links = overlaps(corners, known)
    owners = np.repeat(np.arange(len(corners)), spans[:, 1] - spans[:, 0])
    parts = _inside(_points(corners)[owners], known[links]).sum(axis=1)
    votes = np.zeros((len(corners), members.shape[1]))
    np.add.at(votes, owners, parts[:, None] * np.where(members[links], 1, -1))
    return votes > 0


def _points(corners: np.ndarray) -> np.ndarray:
    """The middles of equal parts of triangles [N, 3, 2], [N, PARTS^2, 2]."""
    first, second = np.mgrid[:PARTS, :PARTS].reshape(2, -1)
    upward = np.stack([first, second], axis=1)[first + second < PARTS] + 1 / 3
    downward = np.stack([first, second], axis=1)[first + second < PARTS - 1] + 2 / 3
    weights = np.concatenate([upward, downward]) / PARTS
    sides = corners[:, 1:] - corners[:, :1]
    return corners[:, :1] + weights @ sides


def _inside(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Whether points [N, P, 2] lie in triangles [N, 3, 2], one for each row, [N, P] bool."""
    inside = np.ones(points.shape[:2], dtype=bool)
    for corner in range(3):
        begin = corners[:, corner, None]
        side = corners[:, (corner + 1) % 3, None] - begin
        away = points - begin
        inside &= side[..., 0] * away[..., 1] - side[..., 1] * away[..., 0] >= 0.0
    return inside
