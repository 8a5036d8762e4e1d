"""Choose the edge that a triangle's texture follows."""

from dataclasses import dataclass

import numpy as np

from stages.edits import turn_base_edge
from stages.hand.find import Point, triangle_at
from stages.hand.worked import Worked


@dataclass(frozen=True)
class TurnBaseEdge:
    """The next edge of the triangle at a point becomes its base edge.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5 ("vertex order").
    """

    frame: int
    """Number of the frame."""
    at: Point
    """A point in the triangle [px]."""

    def apply(self, worked: Worked) -> Worked:
        """Turn the triangle's row.

        Raises:
            EditError: If the point is outside of the picture.
        """
        triangle = triangle_at(worked.mesh, self.at)
        return worked.became(turn_base_edge(worked.mesh, np.array([triangle])))
