"""Paint where errors count more."""

from dataclasses import dataclass, replace

from stages.focus.strength import STRENGTHS
from stages.hand.regions.on_region import OnRegion
from stages.hand.worked import Worked
from stages.masks.area import Stroke
from warp_kernels.errors import EditError


@dataclass(frozen=True, kw_only=True)
class SetFocus(OnRegion):
    """Errors of a region count more, so that it gets more and smaller triangles.

    It follows the triangles that lie there in its frame through their shot.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 7: artists wished to say
        where details are wanted.
    """

    strength: float = 1.0
    """How much it adds, up to 4; at 1 errors count five times."""

    def apply(self, worked: Worked) -> Worked:
        """Paint the region.

        Raises:
            EditError: If it is none of the picture, or there is no such strength.
        """
        super().apply(worked)
        if not 0.0 < self.strength <= STRENGTHS[1]:
            raise EditError(
                f"strength {self.strength:g}: must be above 0 and at most {STRENGTHS[1]:g}; take 1"
            )
        return replace(worked, focus=(*worked.focus, Stroke(self.area, self.strength)))
