"""Insert vertices with a brush."""

from dataclasses import dataclass

import numpy as np

from stages.hand.brush import check_brush, strokes, with_points
from stages.hand.find import Point, check_inside
from stages.hand.worked import Worked


@dataclass(frozen=True)
class Insert:
    """Vertices under a round brush.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5.
    """

    frame: int
    """Number of the frame."""
    at: Point
    """Centre of the brush [px]."""
    radius: float
    """Its radius [px]."""
    count: int = 10
    """How many vertices; fewer where there is no room."""
    spread: str = "uniform"
    """uniform or normal: most in the middle, the radius is then two standard deviations."""
    seed: int = 0
    """Seed of where they fall."""
    lock: bool = True
    """Whether the vertices are held there."""

    def apply(self, worked: Worked) -> Worked:
        """Insert the vertices.

        Raises:
            EditError: If the brush is outside of the picture, or there is no room under it.
        """
        check_inside(worked.mesh, self.at)
        check_brush(self.radius, self.count, self.spread, self.seed)
        points = strokes(self.at, self.radius, self.spread, np.random.default_rng(self.seed))
        return with_points(worked, points, self.count, lock=self.lock)
