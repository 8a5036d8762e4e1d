"""What lies around edges and vertices, for many of them at once."""

import numpy as np

from stages.mesh import Mesh


def edge_triangles(mesh: Mesh, half_edges: np.ndarray) -> np.ndarray:
    """The triangles on both sides of each half-edge, -1 beyond the border; shape [N, 2]."""
    half_edges = np.asarray(half_edges, dtype=np.int64)
    # Floor division takes the twin -1 of a border edge to the triangle -1.
    return np.stack([half_edges // 3, mesh.twins[half_edges] // 3], axis=1)


def edge_ends(
    mesh: Mesh, half_edges: np.ndarray, reverse: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """The vertices that half-edges run from and to.

    Args:
        mesh: The mesh.
        half_edges: Half-edge numbers, shape [N].
        reverse: Where true the ends change places, shape [N] bool. A border edge has only one
            half-edge, so its other direction cannot be named otherwise.

    Returns:
        Vertex numbers: origins [N], destinations [N].
    """
    triangles, corners = np.divmod(np.asarray(half_edges, dtype=np.int64), 3)
    start = mesh.triangles[triangles, corners]
    end = mesh.triangles[triangles, (corners + 1) % 3]
    if reverse is None:
        return start, end
    return np.where(reverse, end, start), np.where(reverse, start, end)


def stars(mesh: Mesh, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """List the corners at each of some vertices.

    Args:
        mesh: The mesh.
        vertices: Vertex numbers, shape [N].

    Returns:
        For every corner found, ascending in the first: its place in `vertices` [M] and its
        half-edge number [M].
    """
    begins = mesh.fan_offsets[vertices]
    counts = mesh.fan_offsets[vertices + 1] - begins
    places = np.repeat(np.arange(len(vertices)), counts)
    within = np.arange(len(places)) - np.repeat(np.cumsum(counts) - counts, counts)
    return places, mesh.fan_corners[begins[places] + within]
