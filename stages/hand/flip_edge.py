"""Flip an edge."""

from dataclasses import dataclass

import numpy as np

from stages.edits import flip_edges, flippable
from stages.edits.neighbourhood import edge_triangles
from stages.hand.find import Point, ends_of, nearest_edge
from stages.hand.worked import Worked
from stages.mesh import Mesh
from warp_kernels.errors import EditError


@dataclass(frozen=True)
class FlipEdge:
    """The edge nearest to a point becomes the other diagonal of its two triangles.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5.
    """

    frame: int
    """Number of the frame."""
    at: Point
    """A point on the edge [px]."""
    lock: bool = True
    """Whether the new edge is held."""

    def apply(self, worked: Worked) -> Worked:
        """Flip the edge.

        Raises:
            EditError: If the point is outside of the picture, the edge lies on the border, or a
                triangle would turn over.
        """
        mesh = worked.mesh
        half_edge, (x, y) = nearest_edge(mesh, self.at)
        if mesh.twins[half_edge] < 0:
            raise EditError(f"the edge at ({x:g}, {y:g}) lies on the border; flip one inside")
        if not flippable(mesh, np.array([half_edge]))[0]:
            raise EditError(
                f"a flip of the edge at ({x:g}, {y:g}) would turn a triangle over; move a vertex "
                "beside it first"
            )
        pair = edge_triangles(mesh, np.array([half_edge]))[0]
        flipped = flip_edges(mesh, np.array([half_edge]))
        locks = worked.locks.without(edges=ends_of(mesh, half_edge))
        if self.lock:
            locks = locks.adding(edges=_common_edge(flipped, pair))
        return worked.became(flipped, locks)


def _common_edge(mesh: Mesh, pair: np.ndarray) -> np.ndarray:
    """Ids of the ends of the edge between two triangles, [2]."""
    common = np.intersect1d(mesh.triangles[pair[0]], mesh.triangles[pair[1]])
    ids: np.ndarray = mesh.vertex_ids[common]
    return ids
