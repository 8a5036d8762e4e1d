"""What a change of topology is to achieve."""

from dataclasses import dataclass, replace
from math import inf

from stages.motion.boiling import Unrest
from stages.motion.rest import Rest


@dataclass(frozen=True)
class Goal:
    """How many triangles, and how much may change on the way."""

    count: int
    """Number of triangles to reach, give or take one."""
    threshold: float | None = None
    """Only triangles with sqrt(E(T) / |I|) above this are split [code values]; None for all."""
    calm: bool = False
    """Whether a picture is being followed: only what clearly pays may change."""
    largest_area: float = inf
    """No triangle may become larger [px^2]."""
    unrest: Unrest | None = None
    """Where a followed picture boils, so that more may change there; None for nowhere."""
    rest: Rest | None = None
    """What has arrived, where nothing need be looked at; None for nothing."""

    def tightened(self, count: int, spare: float) -> "Goal":
        """The same goal with another count, and a part of the area to spare."""
        return replace(self, count=count, largest_area=spare * self.largest_area)


SLIVER_HEIGHT = 0.5
"""Triangles thinner than this collapse [px]: hardly a pixel's centre lies in them."""
