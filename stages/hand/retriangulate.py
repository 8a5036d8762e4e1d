"""Triangulate a region anew."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from stages.hand.brush import check_count, with_points
from stages.hand.find import Point, check_polygon, inside_polygon
from stages.hand.vanish import without_vertices
from stages.hand.worked import Worked


@dataclass(frozen=True)
class Retriangulate:
    """In a polygon all vertices go, and others come, evenly spread and Delaunay.

    What is outside stays, and the new triangles are stitched to it.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5.
    """

    frame: int
    """Number of the frame."""
    polygon: tuple[Point, ...]
    """Corners of the region [px]."""
    count: int = 20
    """How many vertices come; fewer where there is no room."""
    seed: int = 0
    """Seed of where they fall."""
    lock: bool = True
    """Whether the vertices are held there."""

    def apply(self, worked: Worked) -> Worked:
        """Remove what is inside, and insert vertices.

        Raises:
            EditError: If the polygon is outside of the picture, or there is no room in it.
        """
        mesh = worked.mesh
        check_polygon(mesh, self.polygon)
        check_count(self.count, self.seed)
        inner = inside_polygon(mesh.vertices, self.polygon)
        inner &= ~(mesh.on_left_right | mesh.on_top_bottom)
        cleared, _ = without_vertices(worked, np.flatnonzero(inner))
        bare = np.setdiff1d(cleared.locks.bare, worked.locks.bare)
        freed = cleared.became(cleared.mesh, cleared.locks.without(bare=bare))
        return with_points(freed, self._points(), self.count, lock=self.lock)

    def _points(self) -> Iterator[Point]:
        """Points spread evenly over the polygon, without an end."""
        rng = np.random.default_rng(self.seed)
        low, high = np.min(self.polygon, axis=0), np.max(self.polygon, axis=0)
        while True:
            drawn = low + rng.random((64, 2)) * (high - low)
            within = drawn[inside_polygon(drawn, self.polygon)]
            # of a polygon without an area nothing comes: what is drawn then fits nowhere
            for x, y in within if len(within) else drawn[:1] - (high + 1e6):
                yield float(x), float(y)
