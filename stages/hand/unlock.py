"""Let go of vertices or edges."""

from dataclasses import dataclass

from stages.hand.find import Point
from stages.hand.held_region import meant
from stages.hand.worked import Worked


@dataclass(frozen=True)
class Unlock:
    """The vertex or edge nearest to a point, or all in a polygon, are the optimiser's again."""

    frame: int
    """Number of the frame."""
    at: Point | None = None
    """A point at a vertex or on an edge [px]."""
    polygon: tuple[Point, ...] = ()
    """Corners of a region [px], in place of a point."""
    what: str = "vertices"
    """vertices or edges."""

    def apply(self, worked: Worked) -> Worked:
        """Let go of them.

        Raises:
            EditError: If there is nothing such.
        """
        vertices, edges = meant(worked.mesh, self.what, self.at, self.polygon)
        locks = worked.locks.without(vertices=vertices, edges=edges)
        return worked.became(worked.mesh, locks)
