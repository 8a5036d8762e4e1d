"""Insert a vertex into a triangle."""

from dataclasses import dataclass

import numpy as np

from stages.edits import split_triangles
from stages.hand.find import Point, triangle_at
from stages.hand.worked import Worked
from warp_kernels.errors import EditError


@dataclass(frozen=True)
class SplitTriangle:
    """A new vertex in a triangle, at a point.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5.
    Deviation: the vertex comes to where the person points, not to the centroid.
    """

    frame: int
    """Number of the frame."""
    at: Point
    """Where the vertex comes to be [px]."""
    lock: bool = True
    """Whether the vertex is held there."""

    def apply(self, worked: Worked) -> Worked:
        """Split the triangle.

        Raises:
            EditError: If the point is outside of the picture, or on an edge.
        """
        mesh = worked.mesh
        triangle = triangle_at(mesh, self.at)
        try:
            split = split_triangles(mesh, np.array([triangle]), np.array([self.at]))
        except ValueError:
            raise EditError(
                f"({self.at[0]:g}, {self.at[1]:g}) lies on an edge; split the edge, or point "
                "inside of a triangle"
            ) from None
        locks = worked.locks.without(bare=mesh.triangle_ids[[triangle]])
        if self.lock:
            locks = locks.adding(vertices=worked.fresh_vertices(split))
        return worked.became(split, locks)
