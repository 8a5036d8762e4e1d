"""What a person says about a part of the picture that is no change of the mesh by itself."""

from dataclasses import dataclass

from stages.hand.brush import check_radius
from stages.hand.find import Point, check_inside, check_polygon
from stages.hand.worked import Worked
from stages.masks.area import Area
from warp_kernels.errors import EditError


@dataclass(frozen=True, kw_only=True)
class OnRegion:
    """What the kinds share whose region follows the picture through its shot.

    A region is what a round brush touches, or a polygon.
    """

    frame: int
    """Number of the frame."""
    at: Point | None = None
    """Centre of a round brush [px]."""
    radius: float = 0.0
    """Its radius [px]."""
    polygon: tuple[Point, ...] = ()
    """Corners of a region [px], in place of a brush."""

    @property
    def area(self) -> Area:
        """Where it is in the picture of its frame."""
        if self.at is None:
            return Area(polygon=self.polygon)
        return Area(self.at, self.radius)

    def apply(self, worked: Worked) -> Worked:
        """Look whether the region lies in the picture; the mesh stays as it is.

        Raises:
            EditError: If it does not, or is none.
        """
        if (self.at is None) == (not self.polygon):
            raise EditError("give either a brush as at and radius or a region as polygon")
        if self.at is None:
            check_polygon(worked.mesh, self.polygon)
        else:
            check_inside(worked.mesh, self.at)
            check_radius(self.radius)
        return worked
