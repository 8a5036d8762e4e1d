"""Merge one end of an edge into the other."""

from dataclasses import replace

import numpy as np

from stages.edits.neighbourhood import edge_ends, stars
from stages.mesh import Mesh, heights_of


def collapsible(
    mesh: Mesh,
    half_edges: np.ndarray,
    min_height: float | np.ndarray = 0.0,
    reverse: np.ndarray | None = None,
) -> np.ndarray:
    """Which half-edge collapses are legal.

    A corner of the domain never goes, a border vertex only along its border, and every triangle
    that survives around the vanishing vertex keeps a positive height of at least `min_height`.
    No link condition is tested because in the plane it follows: the changed triangles have the
    star's outline as theirs, so all being positive they cover it exactly once.

    Args:
        mesh: The mesh to be edited.
        half_edges: Half-edge numbers, shape [N].
        min_height: Height to keep [px], one for all or shape [N].
        reverse: Where true the destination moves into the origin, shape [N] bool.

    Returns:
        Shape [N] bool.
    """
    half_edges = np.asarray(half_edges, dtype=np.int64)
    origins, destinations = edge_ends(mesh, half_edges, reverse)
    allowed = keeps_border(mesh, half_edges, origins)
    edits, _, heights = collapsed_heights(mesh, origins, destinations)
    kept = (heights > 0) & (heights >= np.broadcast_to(min_height, len(half_edges))[edits])
    allowed[edits[~kept]] = False
    return allowed


def keeps_border(mesh: Mesh, half_edges: np.ndarray, origins: np.ndarray) -> np.ndarray:
    """Whether the border stays as it is when `origins` vanish along half-edges, shape [N] bool."""
    across, along = mesh.on_left_right[origins], mesh.on_top_bottom[origins]
    on_border_edge = mesh.twins[half_edges] < 0
    return ~(across & along) & (~(across | along) | on_border_edge)


def collapsed_heights(
    mesh: Mesh, origins: np.ndarray, destinations: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Smallest heights of the triangles that survive each collapse and change.

    Args:
        mesh: The mesh to be edited.
        origins: Vertices that vanish, shape [N].
        destinations: Vertices that take their place, shape [N].

    Returns:
        For every such triangle its collapse [M], ascending, its number [M] and its height after
        the collapse [px, M], not positive where it would turn over.
    """
    edits, corners = stars(mesh, origins)
    rows = mesh.triangles[corners // 3]
    survives = (rows != destinations[edits][:, None]).all(axis=1)
    edits, corners, rows = edits[survives], corners[survives], rows[survives]
    rows[np.arange(len(rows)), corners % 3] = destinations[edits]
    return edits, corners // 3, heights_of(mesh.vertices[rows])


def collapse_edges(mesh: Mesh, half_edges: np.ndarray, reverse: np.ndarray | None = None) -> Mesh:
    """Merge the origin of each half-edge into its destination, which stays where it is.

    The triangles at the edge vanish. The others around the origin get the destination as a
    corner in its stead and keep their ids; rows and vertices close ranks in their order.

    Args:
        mesh: The mesh to edit.
        half_edges: Half-edge numbers, shape [N]; the stars of the origins do not overlap.
        reverse: Where true the destination moves into the origin, shape [N] bool.

    Raises:
        ValueError: If a collapse is illegal or two of them touch.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.4-3.5.
    """
    half_edges = np.asarray(half_edges, dtype=np.int64)
    refused = half_edges[~collapsible(mesh, half_edges, reverse=reverse)]
    if len(refused):
        raise ValueError(
            f"half-edge {refused[0]} cannot be collapsed: a triangle would turn over or the "
            "border would change; ask `collapsible` first"
        )
    origins, destinations = edge_ends(mesh, half_edges, reverse)
    _, corners = stars(mesh, origins)
    if np.bincount(corners // 3, minlength=1).max() > 1:
        raise ValueError("two collapses touch; choose them with `independent_collapses`")
    target = np.arange(mesh.vertex_count)
    target[origins] = destinations
    rows = target[mesh.triangles]
    whole = (rows != rows[:, [1, 2, 0]]).all(axis=1)
    stays = np.ones(mesh.vertex_count, dtype=bool)
    stays[origins] = False
    renumbered = np.cumsum(stays) - 1
    return replace(
        mesh,
        vertices=mesh.vertices[stays],
        triangles=renumbered[rows[whole]],
        vertex_ids=mesh.vertex_ids[stays],
        triangle_ids=mesh.triangle_ids[whole],
    )
