"""Exchange the diagonal of pairs of triangles."""

from dataclasses import replace

import numpy as np

from stages.edits.neighbourhood import edge_triangles
from stages.mesh import Mesh, areas_of, heights_of, next_corner, previous_corner


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

    The new triangles take the places and the ids of the old ones, the larger those of the larger:
    so they share the most area with what they were. The one edge that such a pair has in common
    keeps its place in the row, hence its texture its direction.

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
    flip_in_place(mesh.vertices, triangles, twins, half_edges)
    return replace(mesh, triangles=triangles).with_twins(twins)


def flipped_rows(
    triangles: np.ndarray, twins: np.ndarray, half_edges: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The rows (a, d, c) and (b, c, d) that replace (a, b, c) and (b, a, d), each [N, 3]."""
    corners = triangles.reshape(-1)
    a, b = corners[half_edges], corners[next_corner(half_edges)]
    c = corners[previous_corner(half_edges)]
    d = corners[previous_corner(twins[half_edges])]
    return np.stack([a, d, c], axis=1), np.stack([b, c, d], axis=1)


def flip_in_place(
    vertices: np.ndarray, triangles: np.ndarray, twins: np.ndarray, half_edges: np.ndarray
) -> np.ndarray:
    """Flip independent inner edges in working tables, at a cost of their number.

    Of each triangle one corner moves to the far end of the new diagonal: either the one at the
    end of its half-edge, or the one at its begin.

    Args:
        vertices: Positions [px], shape [V, 2].
        triangles: Rows, shape [T, 3]; updated.
        twins: Twin table, shape [3T] int32; updated.
        half_edges: Half-edge numbers, shape [N]; no two edges share a triangle.

    Returns:
        Half-edges around the pairs, shape [4N].
    """
    opposite = twins[half_edges]
    begins = _begins_move(vertices, triangles, twins, half_edges)
    corners = triangles.reshape(-1)
    c, d = corners[previous_corner(half_edges)], corners[previous_corner(opposite)]
    corners[np.where(begins, half_edges, next_corner(half_edges))] = d
    corners[np.where(begins, opposite, next_corner(opposite))] = c
    # The places of the new diagonal are those of the edges that change triangles, which go where
    # the old diagonal was.
    left, right = (
        np.where(begins, previous_corner(e), next_corner(e)) for e in (half_edges, opposite)
    )
    before, after = np.concatenate([right, left]), np.concatenate([half_edges, opposite])
    moved = np.arange(len(twins), dtype=np.int32)
    moved[before] = after
    # A neighbour across the outline may be flipped in the same batch: its number moves as well.
    neighbours = twins[before]
    inner = neighbours >= 0
    neighbours[inner] = moved[neighbours[inner]]
    twins[after] = neighbours
    twins[neighbours[inner]] = after[inner]
    twins[left], twins[right] = right, left
    diagonals = np.concatenate([left, right])
    return np.concatenate([next_corner(diagonals), previous_corner(diagonals)])


def _begins_move(
    vertices: np.ndarray, triangles: np.ndarray, twins: np.ndarray, half_edges: np.ndarray
) -> np.ndarray:
    """Whether (a, b, c) becomes (d, b, c) rather than (a, d, c), [N] bool.

    The diagonals cut each other in the ratio of the new areas, so the common area is largest
    where the larger of the old triangles becomes the larger of the new ones.
    """
    near_a, near_b = flipped_rows(triangles, twins, half_edges)
    new = areas_of(vertices[near_a]) - areas_of(vertices[near_b])
    left, right = triangles[half_edges // 3], triangles[twins[half_edges] // 3]
    old = areas_of(vertices[left]) - areas_of(vertices[right])
    return new * old < 0
