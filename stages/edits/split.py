"""Insert vertices into triangles and edges."""

from dataclasses import replace

import numpy as np

from stages.edits.neighbourhood import edge_ends, edge_triangles
from stages.mesh import Mesh, areas_of


def split_triangles(mesh: Mesh, triangles: np.ndarray, points: np.ndarray | None = None) -> Mesh:
    """Insert a vertex into each of some triangles.

    Every child is its parent's row with one corner replaced by the new vertex. The largest takes
    the parent's place and id, the other two are appended and have fresh ids.

    Args:
        mesh: The mesh to edit.
        triangles: Triangle numbers, shape [N], without repetition.
        points: Positions [px] strictly inside the triangles, shape [N, 2]; else the centroids.

    Raises:
        ValueError: If a triangle is named twice or a point lies outside its triangle.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.4.
    """
    triangles = np.asarray(triangles, dtype=np.int64)
    _check_separate(triangles)
    parents = mesh.triangles[triangles]
    if points is None:
        points = mesh.vertices[parents].mean(axis=1)
    children = np.repeat(parents[None], 3, axis=0)  # [child, N, corner]
    for child, replaced_corner in enumerate((2, 0, 1)):
        children[child, :, replaced_corner] = mesh.vertex_count + np.arange(len(triangles))
    return _with_children(mesh, points, triangles, children)


def split_edges(mesh: Mesh, half_edges: np.ndarray, points: np.ndarray | None = None) -> Mesh:
    """Insert a vertex into each of some edges, inner or on the border.

    Both children of a triangle are its row with one end of the edge replaced by the new vertex.
    The larger takes the parent's place and id, the other is appended and has a fresh one.

    Args:
        mesh: The mesh to edit.
        half_edges: Half-edge numbers, shape [N]; no two edges share a triangle.
        points: Positions [px] that give the children positive areas, shape [N, 2]; on a border
            edge they lie on that border. Else the midpoints.

    Raises:
        ValueError: If two edges share a triangle or a point does not fit.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5.
    """
    beside = edge_triangles(mesh, half_edges)
    edges, sides = np.nonzero(beside >= 0)
    parents = beside[edges, sides]
    _check_separate(parents)
    origins, destinations = edge_ends(mesh, half_edges)
    ends = mesh.vertices[np.stack([origins, destinations], axis=1)]
    if points is None:
        points = ends.mean(axis=1)
    points = np.asarray(points, dtype=np.float64)
    off_border = (ends[:, 0] == ends[:, 1]) & (ends[:, 0] != points)
    if (off_border.any(axis=1) & (beside[:, 1] < 0)).any():
        raise ValueError("a point that splits a border edge must lie on the border")
    rows = mesh.triangles[parents]
    fresh = (mesh.vertex_count + edges)[:, None]
    children = np.stack(
        [
            np.where(rows == destinations[edges][:, None], fresh, rows),
            np.where(rows == origins[edges][:, None], fresh, rows),
        ]
    )
    return _with_children(mesh, points, parents, children)


def _check_separate(parents: np.ndarray) -> None:
    """Refuse a set of edits that names a triangle twice."""
    repeated = np.flatnonzero(np.bincount(parents, minlength=1) > 1)
    if len(repeated):
        raise ValueError(f"triangle {repeated[0]} is split twice; choose edits that do not touch")


def _with_children(
    mesh: Mesh, points: np.ndarray, parents: np.ndarray, children: np.ndarray
) -> Mesh:
    """Replace triangles by their children around new vertices.

    Args:
        mesh: The mesh to edit.
        points: New vertices [px], shape [N, 2].
        parents: Triangle numbers, shape [M].
        children: Rows, shape [C, M, 3]; of C the largest takes the parent's place and id.

    Raises:
        ValueError: If a child has no positive area.
    """
    vertices = np.concatenate([mesh.vertices, points])
    areas = areas_of(vertices[children.reshape(-1, 3)]).reshape(len(children), -1)
    if not (areas > 0).all():
        parent = parents[areas.min(axis=0).argmin()]
        raise ValueError(f"the point for triangle {parent} does not lie strictly inside it")
    largest_first = np.argsort(-areas, axis=0, kind="stable")
    children = np.take_along_axis(children, largest_first[:, :, None], axis=0)
    rows = np.concatenate([mesh.triangles, children[1:].reshape(-1, 3)])
    rows[parents] = children[0]
    new_triangle_ids = mesh.next_triangle_id + np.arange(len(rows) - mesh.triangle_count)
    new_vertex_ids = mesh.next_vertex_id + np.arange(len(points))
    return replace(
        mesh,
        vertices=vertices,
        triangles=rows,
        vertex_ids=np.concatenate([mesh.vertex_ids, new_vertex_ids]),
        triangle_ids=np.concatenate([mesh.triangle_ids, new_triangle_ids]),
        next_vertex_id=mesh.next_vertex_id + len(points),
        next_triangle_id=mesh.next_triangle_id + len(new_triangle_ids),
    )
