"""Edges and triangles of two meshes, named by their vertices so that they can be compared."""

import numpy as np

from stages.mesh import Mesh


def numbers_of(before: Mesh, after: Mesh) -> tuple[np.ndarray, np.ndarray, int]:
    """Number the vertices of two meshes together, densely, by their ids.

    Returns:
        The numbers of the vertices of `before` [V] and of `after` [V'], and how many there are.
    """
    known = np.union1d(before.vertex_ids, after.vertex_ids)
    first, second = (np.searchsorted(known, mesh.vertex_ids) for mesh in (before, after))
    return first, second, len(known)


def keys_of(rows: np.ndarray, count: int) -> np.ndarray:
    """One number for each edge or triangle, whatever the order of its vertices.

    Args:
        rows: Vertex numbers below `count`, shape [N, 2] or [N, 3].
        count: At most 2 million for triangles.

    Returns:
        Shape [N] int64.
    """
    keys = np.zeros(len(rows), dtype=np.int64)
    for column in np.sort(rows, axis=1).T:
        keys = keys * count + column
    return keys
