"""What leads from one picture to the next."""

from dataclasses import dataclass

import numpy as np

from stages.flows import Flow
from stages.flows.deforming import shapes
from stages.flows.field import FlowField
from stages.flows.patch_matching import LINES, unlikeness, vote
from stages.flows.pursuit import LINES as CLOSE_LINES
from stages.flows.pursuit import pursue
from stages.flows.view import View

DOUBTFUL = 2.0
"""Motion is trusted by half where patches differ by this in the mean [code values]; found by trial
on three clips, see docs/following.md."""
SPARSE = 37
"""Pictures are compared row by row of so many before they are compared as a whole."""


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
        if _are_equal(earlier.pixels, later.pixels):
            return cls(FlowField.still(later.width, later.height), earlier, later, is_still=True)
        return cls(flow.estimate(earlier, later), earlier, later)

    def follow(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Motion of points, each of which stands on what is in front.

        Args:
            points: Positions in the earlier picture [px], shape [N, 2].

        Returns:
            Motion [px], shape [N, 2], and how far it is to be trusted [0..1], shape [N].
        """
        pictures = self.earlier.reduced(LINES), self.later.reduced(LINES)
        steps, misfits = vote(points, self.flow, *pictures)
        return steps, 1.0 / (1.0 + (misfits.astype(np.float64) / DOUBTFUL) ** 2)

    def pursue(self, points: np.ndarray, steps: np.ndarray) -> np.ndarray:
        """Follow a few points more closely than all others.

        Args:
            points: Positions in the earlier picture [px], shape [N, 2].
            steps: Estimates of their motion [px], shape [N, 2].

        Returns:
            Motion [px], shape [N, 2].
        """
        earlier, later = self.earlier.reduced(CLOSE_LINES), self.later.reduced(CLOSE_LINES)
        scale = np.array([earlier.shape[1] / self.flow.width, earlier.shape[0] / self.flow.height])
        turns = shapes(self.flow, points)
        return pursue(scale * points, scale * steps, turns, earlier, later) / scale

    def unlikeness(self, points: np.ndarray, steps: np.ndarray) -> np.ndarray:
        """How much the picture around points looks unlike that around where they went.

        Args:
            points: Positions in the earlier picture [px], shape [N, 2].
            steps: Their steps [px], shape [N, 2].

        Returns:
            Misfit and contrast of the patches [code values], shape [N, 2].
        """
        earlier, later = self.earlier.reduced(LINES), self.later.reduced(LINES)
        scale = np.array([earlier.shape[1] / self.flow.width, earlier.shape[0] / self.flow.height])
        return unlikeness(scale * points, scale * steps, earlier, later)


def _are_equal(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two pictures are the same to the bit; what moves is seen in a few rows already."""
    return np.array_equal(one[::SPARSE], other[::SPARSE]) and np.array_equal(one, other)
