"""Hold vertices or edges fast."""

from dataclasses import dataclass

from stages.hand.find import Point
from stages.hand.held_region import meant
from stages.hand.worked import Worked


@dataclass(frozen=True)
class Lock:
    """The vertex or edge nearest to a point, or all in a polygon, are held fast."""

    frame: int
    """Number of the frame."""
    at: Point | None = None
    """A point at a vertex or on an edge [px]."""
    polygon: tuple[Point, ...] = ()
    """Corners of a region [px], in place of a point."""
    what: str = "vertices"
    """vertices or edges."""

    def apply(self, worked: Worked) -> Worked:
        """Hold them.

        Raises:
            EditError: If there is nothing such.
        """
        vertices, edges = meant(worked.mesh, self.what, self.at, self.polygon)
        locks = worked.locks.adding(vertices=vertices, edges=edges)
        return worked.became(worked.mesh, locks)
