"""Which vertices or edges a lock means."""

import numpy as np

from stages.hand.find import (
    Point,
    check_polygon,
    ends_of,
    inside_polygon,
    nearest_edge,
    nearest_vertex,
)
from stages.mesh import Mesh
from warp_kernels.errors import EditError

WHAT = ("vertices", "edges")
"""What can be held."""


def meant(
    mesh: Mesh, what: str, at: Point | None, polygon: tuple[Point, ...]
) -> tuple[np.ndarray, np.ndarray]:
    """Ids of vertices [N], and of the ends of edges [M, 2].

    Args:
        mesh: The mesh.
        what: One of `WHAT`.
        at: A point: the nearest one is meant; or None.
        polygon: Corners of a region: all in it are meant; or none.

    Raises:
        EditError: If nothing is meant.
    """
    if what not in WHAT:
        raise EditError(f"what {what!r}: choose from {', '.join(WHAT)}")
    if (at is None) == (not polygon):
        raise EditError("give either a point as at or a region as polygon")
    nothing = np.empty(0, dtype=np.int64)
    if at is not None:
        if what == "vertices":
            return mesh.vertex_ids[[nearest_vertex(mesh, at)]], nothing.reshape(0, 2)
        return nothing, ends_of(mesh, nearest_edge(mesh, at)[0])[None]
    check_polygon(mesh, polygon)
    inside = inside_polygon(mesh.vertices, polygon)
    edges = mesh.edge_vertices[inside[mesh.edge_vertices].all(axis=1)]
    found = inside.any() if what == "vertices" else len(edges)
    if not found:
        raise EditError(f"the polygon holds no {what}; draw a larger one")
    if what == "vertices":
        return mesh.vertex_ids[inside], nothing.reshape(0, 2)
    return nothing, mesh.vertex_ids[edges]
