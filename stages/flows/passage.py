"""What leads from one picture to the next."""

from dataclasses import dataclass

import numpy as np

from stages.flows import Flow
from stages.flows.field import FlowField
from stages.flows.view import View
from stages.flows.vote import LINES, vote

DOUBTFUL = 2.0
"""Motion is trusted by half where patches differ by this in the mean [code values]; found by trial
on three clips, see docs/following.md."""
CLOSING = 0.2
"""A point may be covered where the motion around it closes in faster than this [1/frame]."""
LOST = 6.0
"""It is, if its patch is not found again either: the best differs by more than this [code values].
Lower bars find more of what is covered on sequences of known motion, and take more than they should
from films, see docs/following.md."""


@dataclass(frozen=True, eq=False)
class Passage:
    """Motion from a picture to the next, and both pictures to check it against."""

    flow: FlowField
    """The estimate."""
    earlier: View
    """The picture that it leads from."""
    later: View
    """The picture that it leads to."""
    is_still: bool = False
    """Whether both pictures are the same to the bit."""

    @classmethod
    def between(cls, flow: Flow, earlier: View, later: View) -> "Passage":
        """The passage between two pictures.

        Args:
            flow: Estimates the motion.
            earlier: A picture.
            later: The next one, of the same size.
        """
        if np.array_equal(earlier.pixels, later.pixels):
            return cls(FlowField.still(later.width, later.height), earlier, later, is_still=True)
        return cls(flow.estimate(earlier, later), earlier, later)

    def follow(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Motion of points, each of which stands on what is in front.

        Args:
            points: Positions in the earlier picture [px], shape [N, 2].

        Returns:
            Motion [px], shape [N, 2]; how far it is to be trusted [0..1], shape [N]; and which
            points something comes to lie over, shape [N] bool.

        Source: Sand & Teller, Particle Video (2006), tell what is covered by the same two signs.
        Deviation: no flow back is compared. It costs as much again, and at the same number of
            points marked wrongly it finds hardly more of what is covered.
        """
        pictures = self.earlier.reduced(LINES), self.later.reduced(LINES)
        steps, misfits, closing = vote(points, self.flow, *pictures)
        trust = 1.0 / (1.0 + (misfits.astype(np.float64) / DOUBTFUL) ** 2)
        return steps, trust, (closing > CLOSING) & (misfits > LOST)
