"""Which vertices and triangles two meshes of one shot have in common."""

import numpy as np

from stages.mesh import Mesh


def kept_vertices(before: Mesh, after: Mesh) -> np.ndarray:
    """Where the vertices of a mesh stand in another, by their persistent ids.

    Args:
        before: One mesh.
        after: Another one of the same shot.

    Returns:
        For every vertex of `after` its number in `before`, or -1; shape [V] int64.
    """
    return kept_rows(before.vertex_ids, after.vertex_ids)


def kept_triangles(before: Mesh, after: Mesh) -> np.ndarray:
    """Where the triangles of a mesh stand in another: those between the same three vertices.

    Ids of triangles do not tell: an edit changes corners and keeps ids, some flips bring a triangle
    back under another id, and a row may be turned to start with another corner.

    Args:
        before: One mesh.
        after: Another one of the same shot.

    Returns:
        For every triangle of `after` its number in `before`, or -1; shape [T] int64.
    """
    vertices = kept_vertices(before, after)
    rows = vertices[after.triangles]
    if rows.shape == before.triangles.shape and np.array_equal(rows, before.triangles):
        return np.arange(after.triangle_count)
    whole = (rows >= 0).all(axis=1)
    kept = np.full(after.triangle_count, -1, dtype=np.int64)
    # V^3 stays below 2^63 for two million vertices, more than the largest picture holds.
    count = before.vertex_count
    kept[whole] = _places(_keys(before.triangles, count), _keys(rows[whole], count))
    return kept


def kept_rows(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Where ids stand among those of another frame.

    Args:
        before: Persistent numbers without repetition, [N] int64.
        after: Others, [M] int64.

    Returns:
        For each of `after` its row in `before`, or -1; shape [M] int64.
    """
    if np.array_equal(before, after):
        return np.arange(len(after))
    return _places(before, after)


def by_vertex_id(mesh: Mesh, triangles: np.ndarray | None = None) -> np.ndarray:
    """Rows whose corners ascend by their persistent ids: the same in all meshes that share them.

    Args:
        mesh: The mesh.
        triangles: Triangle numbers [N]; all, if left out.

    Returns:
        Vertex numbers, shape [N, 3].
    """
    rows = mesh.triangles if triangles is None else mesh.triangles[triangles]
    order = np.argsort(mesh.vertex_ids[rows], axis=1)
    return np.take_along_axis(rows, order, axis=1)


def _keys(rows: np.ndarray, count: int) -> np.ndarray:
    """One number for each set of three vertices [N]."""
    first, second, third = np.sort(rows.astype(np.int64), axis=1).T
    return (first * count + second) * count + third


def _places(known: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Where each wanted number stands among known ones without repetition, or -1."""
    order = np.argsort(known, kind="stable")
    found = np.minimum(np.searchsorted(known[order], wanted), len(known) - 1)
    places = order[found]
    return np.where(known[places] == wanted, places, -1)
