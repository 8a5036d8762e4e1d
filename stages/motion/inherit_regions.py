"""Which triangles belong to a region: those under a mask in one frame, from there their heirs."""

import numpy as np

from stages.mesh import Mesh
from stages.motion.beneath import Shares, beneath, parts_of
from stages.motion.correspondence import kept_triangles
from stages.snapshot import Snapshot, colors_at_centres

PARTS = 8
"""A triangle is looked at in the middle of so many times so many equal parts."""
ALIKE = 40.0
"""Colours that are so far apart count a quarter of equal ones [code values]."""
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
    points = parts_of(mesh.vertices[mesh.triangles], PARTS)
    columns, rows = (
        np.clip(points[..., axis].astype(int), 0, mask.shape[1 - axis] - 1) for axis in (0, 1)
    )
    return (mask[rows, columns] > HALF).mean(axis=1) > 0.5


def inherited(before: Snapshot, after: Snapshot, members: np.ndarray) -> np.ndarray:
    """Carry regions on to a neighbouring frame of a shot, the next one or the one before.

    Triangles that both have keep what they were. About a new one those vote that lay where it
    lies and those beside it, by the share of it that they cover or touch, and the more the more
    alike they look: where a shape uncovers what is behind it that is not taken for the shape.

    Args:
        before: The frame whose triangles are known.
        after: The neighbouring frame.
        members: Whether the triangles of `before` belong to each region, [T, R] bool.

    Returns:
        The same of `after`; `members` itself if no triangle came or went.
    """
    mesh = after.mesh
    kept = kept_triangles(before.mesh, mesh)
    if np.array_equal(kept, np.arange(before.mesh.triangle_count)):
        return members
    born = np.flatnonzero(kept < 0)
    colors = [colors_at_centres(s.mesh, s.model, s.coefficients) for s in (before, after)]
    votes = np.zeros((len(born), members.shape[1]))
    for voters in (beneath(before.mesh, mesh, born, PARTS), _beside(mesh, kept, born)):
        owners, others, shares = voters
        away = np.square(colors[1][born[owners]] - colors[0][others]).sum(axis=1)
        weights = shares / np.square(1.0 + away / ALIKE**2)
        np.add.at(votes, owners, weights[:, None] * np.where(members[others], 1.0, -1.0))
    found = members[kept]
    found[born] = votes > 0.0
    return found


def _beside(mesh: Mesh, kept: np.ndarray, born: np.ndarray) -> Shares:
    """The known triangles beside new ones, by the part of their outline that they touch.

    Args:
        mesh: The new ones' mesh.
        kept: Numbers of its triangles in the mesh before, or -1, [T].
        born: Numbers of the new ones, [N].
    """
    twins = mesh.twins.reshape(-1, 3)[born]
    sides = mesh.vertices[mesh.triangles[born]]
    lengths = np.linalg.norm(np.roll(sides, -1, axis=1) - sides, axis=2)
    shares = lengths / lengths.sum(axis=1, keepdims=True)
    others = np.where(twins >= 0, kept[twins // 3], -1)
    owners, corners = np.nonzero(others >= 0)
    return owners, others[owners, corners], shares[owners, corners]
