"""Press flat triangles on the border out of the mesh: their apexes become border vertices."""

from dataclasses import replace

import numpy as np

from stages.edits.neighbourhood import stars
from stages.mesh import Mesh, heights_of, next_corner, previous_corner


def pressable(mesh: Mesh, half_edges: np.ndarray, min_height: float = 0.0) -> np.ndarray:
    """Which edges have a triangle that can be pressed onto them.

    The edge lies on the border and the apex across it does not, the apex falls between the ends
    of the edge, and the triangles around it keep their height.

    Args:
        mesh: The mesh to be edited.
        half_edges: Half-edge numbers, shape [N].
        min_height: Height that the triangles around the apex keep [px].

    Returns:
        Shape [N] bool.
    """
    half_edges = np.asarray(half_edges, dtype=np.int64)
    apexes, points = _pressed(mesh, half_edges)
    inside = ~(mesh.on_left_right | mesh.on_top_bottom)[apexes]
    allowed = inside & (mesh.twins[half_edges] < 0)
    places, corners = stars(mesh, apexes)
    kept = corners // 3 != half_edges[places] // 3
    places, corners = places[kept], corners[kept]
    positions = mesh.vertices[mesh.triangles[corners // 3]]
    positions[np.arange(len(corners)), corners % 3] = points[places]
    heights = heights_of(positions)
    allowed[places[(heights <= 0) | (heights < min_height)]] = False
    return allowed


def press_onto_border(mesh: Mesh, half_edges: np.ndarray) -> Mesh:
    """Remove triangles on the border and let their apexes take their place there.

    The apexes keep their ids, and so do the triangles around them.

    Args:
        mesh: The mesh to edit.
        half_edges: The triangles' edges on the border, shape [N]; no two apexes share a triangle.

    Raises:
        ValueError: If a triangle cannot be pressed or two of them touch.

    Deviation: the paper does not turn inner vertices into border ones; without that a picture
        whose first mesh has few vertices on the border never gets those that it needs.
    """
    half_edges = np.asarray(half_edges, dtype=np.int64)
    refused = half_edges[~pressable(mesh, half_edges)]
    if len(refused):
        raise ValueError(
            f"the triangle at half-edge {refused[0]} cannot be pressed onto the border; "
            "ask `pressable` first"
        )
    apexes, points = _pressed(mesh, half_edges)
    _, corners = stars(mesh, apexes)
    if np.bincount(corners // 3, minlength=1).max() > 1:
        raise ValueError("two apexes share a triangle; press one of them at a time")
    vertices = mesh.vertices.copy()
    vertices[apexes] = points
    stays = np.ones(mesh.triangle_count, dtype=bool)
    stays[half_edges // 3] = False
    return replace(
        mesh,
        vertices=vertices,
        triangles=mesh.triangles[stays],
        triangle_ids=mesh.triangle_ids[stays],
    )


def _pressed(mesh: Mesh, half_edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Apexes across border edges, [N], and where each falls onto its edge [px], [N, 2]."""
    corners = mesh.triangles.reshape(-1)
    apexes = corners[previous_corner(half_edges)]
    start = mesh.vertices[corners[half_edges]]
    end = mesh.vertices[corners[next_corner(half_edges)]]
    # a border edge runs along an axis: its ends share the other coordinate
    points = np.where(start == end, start, mesh.vertices[apexes])
    return apexes, points
