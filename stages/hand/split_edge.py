"""Insert a vertex into an edge."""

from dataclasses import dataclass

import numpy as np

from stages.edits import split_edges
from stages.hand.find import Point, nearest_edge
from stages.hand.worked import Worked
from warp_kernels.errors import EditError

CLOSEST = 0.5
"""A new vertex keeps this far from those that are there [px]."""


@dataclass(frozen=True)
class SplitEdge:
    """A new vertex on the edge nearest to a point.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5.
    Deviation: the vertex comes to where the person points, not to the middle.
    """

    frame: int
    """Number of the frame."""
    at: Point
    """A point on the edge [px]."""
    lock: bool = True
    """Whether the vertex is held there."""

    def apply(self, worked: Worked) -> Worked:
        """Split the edge.

        Raises:
            EditError: If the place is outside of the picture, or at an end of the edge.
        """
        mesh = worked.mesh
        half_edge, place = nearest_edge(mesh, self.at)
        gaps = np.linalg.norm(mesh.vertices - place, axis=1)
        if gaps.min() < CLOSEST:
            raise EditError(
                f"a vertex at ({place[0]:g}, {place[1]:g}) is there already; point further from "
                "the ends of the edge"
            )
        beside = [half_edge // 3, *(mesh.twins[[half_edge]] // 3)]
        try:
            split = split_edges(mesh, np.array([half_edge]), place[None])
        except ValueError:
            raise EditError(
                f"the edge at ({place[0]:g}, {place[1]:g}) is too short to be split; point at a "
                "longer one"
            ) from None
        locks = worked.locks.without(bare=mesh.triangle_ids[[t for t in beside if t >= 0]])
        if self.lock:
            locks = locks.adding(vertices=worked.fresh_vertices(split))
        return worked.became(split, locks)
