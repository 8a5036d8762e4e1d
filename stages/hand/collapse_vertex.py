"""Take a vertex away."""

from dataclasses import dataclass

import numpy as np

from stages.hand.find import Point, nearest_vertex
from stages.hand.vanish import without_vertices
from stages.hand.worked import Worked
from warp_kernels.errors import EditError


@dataclass(frozen=True)
class CollapseVertex:
    """The vertex nearest to a point goes into its nearest neighbour, and none comes back there.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5.
    Deviation: into the nearest one that turns no triangle over.
    """

    frame: int
    """Number of the frame."""
    at: Point
    """A point at the vertex [px]."""

    def apply(self, worked: Worked) -> Worked:
        """Collapse the vertex.

        Raises:
            EditError: If the point is outside of the picture, or the vertex cannot go.
        """
        mesh = worked.mesh
        vertex = nearest_vertex(mesh, self.at)
        x, y = mesh.vertices[vertex]
        if mesh.on_left_right[vertex] and mesh.on_top_bottom[vertex]:
            raise EditError(
                f"({x:g}, {y:g}) is a corner of the picture, which stays; point at another vertex"
            )
        found, gone = without_vertices(worked, np.array([vertex]))
        if not gone:
            raise EditError(
                f"the vertex at ({x:g}, {y:g}) cannot go without turning a triangle over; flip an "
                "edge beside it first"
            )
        return found
