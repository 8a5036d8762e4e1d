"""Move a vertex."""

from dataclasses import dataclass

import numpy as np

from stages.edits.neighbourhood import stars
from stages.hand.find import Point, check_inside, nearest_vertex
from stages.hand.worked import Worked
from stages.mesh import areas_of
from warp_kernels.errors import EditError


@dataclass(frozen=True)
class MoveVertex:
    """The vertex nearest to a point goes to another one; on the border it slides along that."""

    frame: int
    """Number of the frame."""
    at: Point
    """A point at the vertex [px]."""
    to: Point
    """Where it goes [px]."""
    lock: bool = True
    """Whether the vertex is held there."""

    def apply(self, worked: Worked) -> Worked:
        """Move the vertex.

        Raises:
            EditError: If a point is outside of the picture, or a triangle would turn over.
        """
        mesh = worked.mesh
        vertex = nearest_vertex(mesh, self.at)
        x, y = mesh.vertices[vertex]
        fixed = np.array([mesh.on_left_right[vertex], mesh.on_top_bottom[vertex]])
        if fixed.all():
            raise EditError(
                f"({x:g}, {y:g}) is a corner of the picture, which stays; point at another vertex"
            )
        place = np.where(fixed, (x, y), check_inside(mesh, self.to))
        size = np.array([mesh.width, mesh.height])
        vertices = mesh.vertices.copy()
        vertices[vertex] = place
        _, corners = stars(mesh, np.array([vertex]))
        turned = (areas_of(vertices[mesh.triangles[corners // 3]]) <= 0).any()
        if turned or (~fixed & ((place == 0) | (place == size))).any():
            raise EditError(
                f"the vertex at ({x:g}, {y:g}) cannot go to ({place[0]:g}, {place[1]:g}): a "
                "triangle would turn over; move it less far, or flip an edge first"
            )
        moved = mesh.moved(vertices)
        ids = mesh.vertex_ids[[vertex]]
        return worked.became(moved, worked.locks.adding(vertices=ids) if self.lock else None)
