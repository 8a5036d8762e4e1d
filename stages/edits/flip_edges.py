"""Exchange the diagonal of pairs of triangles."""

from dataclasses import replace

import numpy as np

from stages.edits.neighbourhood import edge_triangles
from stages.mesh import Mesh, heights_of, next_corner, previous_corner


def flippable(mesh: Mesh, half_edges: np.ndarray, min_height: float = 0.0) -> np.ndarray:
    """Which edges may be flipped: inner ones in a strictly convex pair of triangles.

    Args:
        mesh: The mesh to be edited.
        half_edges: Half-edge numbers, shape [N].
        min_height: Height that both new triangles must exceed [px].

    Returns:
        Shape [N] bool.
    """
    half_edges = np.asarray(half_edges, dtype=np.int64)
    inner = mesh.twins[half_edges] >= 0
    heights = np.full(len(half_edges), -np.inf)
    heights[inner] = flipped_heights(mesh, half_edges[inner])
    return heights > min_height


def flipped_heights(mesh: Mesh, half_edges: np.ndarray) -> np.ndarray:
    """Smallest height of the two triangles that each flip would make.

    Args:
        mesh: The mesh to be edited.
        half_edges: Numbers of inner half-edges, shape [N].

    Returns:
        Heights [px], shape [N]; not positive where the pair is not strictly convex.
    """
    first, second = flipped_rows(mesh.triangles, mesh.twins, half_edges)
    return np.minimum(heights_of(mesh.vertices[first]), heights_of(mesh.vertices[second]))


def flip_edges(mesh: Mesh, half_edges: np.ndarray) -> Mesh:
    """Flip inner edges: triangles (a, b, c) and (b, a, d) become (a, d, c) and (b, c, d).

    The new triangles take the places of the old ones and have fresh ids. Each starts with an
    edge of the pair's outline, so no texture follows the new diagonal.

    Args:
        mesh: The mesh to edit.
        half_edges: Half-edge numbers, shape [N]; no two edges share a triangle.

    Raises:
        ValueError: If an edge lies on the border or in a pair that is not strictly convex, or
            if two edges share a triangle.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5.
    """
    half_edges = np.asarray(half_edges, dtype=np.int64)
    refused = half_edges[~flippable(mesh, half_edges)]
    if len(refused):
        raise ValueError(
            f"half-edge {refused[0]} cannot be flipped: it lies on the border or its triangles "
            "are not strictly convex together; ask `flippable` first"
        )
    pairs = edge_triangles(mesh, half_edges)
    if np.bincount(pairs.ravel(), minlength=1).max() > 1:
        raise ValueError("two flips share a triangle; choose them with `independent_flips`")
    triangles, twins = mesh.triangles.copy(), mesh.twins.copy()
    flip_in_place(triangles, twins, half_edges)
    return with_changed_rows(mesh, triangles, twins, pairs.ravel())


def with_changed_rows(
    mesh: Mesh, triangles: np.ndarray, twins: np.ndarray, changed: np.ndarray
) -> Mesh:
    """A mesh after flips.

    Args:
        mesh: The mesh before.
        triangles: All rows after, shape [T, 3].
        twins: Their twin table, shape [3T] int32.
        changed: Numbers of the triangles that were flipped, shape [N]; they get fresh ids.
    """
    ids = mesh.triangle_ids.copy()
    ids[changed] = mesh.next_triangle_id + np.arange(len(changed))
    flipped = replace(
        mesh,
        triangles=triangles,
        triangle_ids=ids,
        next_triangle_id=mesh.next_triangle_id + len(changed),
    )
    return flipped.with_twins(twins)


def flipped_rows(
    triangles: np.ndarray, twins: np.ndarray, half_edges: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The rows (a, d, c) and (b, c, d) that replace (a, b, c) and (b, a, d), each [N, 3]."""
    corners = triangles.reshape(-1)
    a, b = corners[half_edges], corners[next_corner(half_edges)]
    c = corners[previous_corner(half_edges)]
    d = corners[previous_corner(twins[half_edges])]
    return np.stack([a, d, c], axis=1), np.stack([b, c, d], axis=1)


def flip_in_place(triangles: np.ndarray, twins: np.ndarray, half_edges: np.ndarray) -> None:
    """Flip independent inner edges in working tables, at a cost of their number.

    Args:
        triangles: Rows, shape [T, 3]; updated.
        twins: Twin table, shape [3T] int32; updated.
        half_edges: Half-edge numbers, shape [N]; no two edges share a triangle.
    """
    opposite = twins[half_edges]
    left, right = half_edges // 3, opposite // 3
    rows = flipped_rows(triangles, twins, half_edges)
    # The outline d<-a, c->a, b->c, d->b before and after; corner 1 of both is the new diagonal.
    before = np.concatenate(
        [
            next_corner(opposite),
            previous_corner(half_edges),
            next_corner(half_edges),
            previous_corner(opposite),
        ]
    )
    after = np.concatenate([3 * left, 3 * left + 2, 3 * right, 3 * right + 2])
    moved = np.arange(len(twins), dtype=np.int32)
    moved[before] = after
    # A neighbour across the outline may be flipped in the same batch: its number moves as well.
    neighbours = twins[before]
    inner = neighbours >= 0
    neighbours[inner] = moved[neighbours[inner]]
    triangles[left], triangles[right] = rows
    twins[after] = neighbours
    twins[neighbours[inner]] = after[inner]
    twins[3 * left + 1], twins[3 * right + 1] = 3 * right + 1, 3 * left + 1
