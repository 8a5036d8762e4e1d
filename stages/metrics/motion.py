"""The motion between two frames of a source, both ways."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stages.flows.dis import Dis
from stages.flows.field import FlowField
from stages.flows.view import View
from stages.metrics.visible import visible
from stages.metrics.warp import dense

REFERENCE_FLOW = Dis(lines=360, preset="fine")
"""The most accurate member for its cost, on pictures of at most 360 lines."""


@dataclass(frozen=True, eq=False)
class SourceMotion:
    """How a source moves from an earlier to a later frame."""

    forward: FlowField
    """Motion from the earlier to the later frame."""
    backward: FlowField
    """Motion from the later to the earlier frame."""

    @classmethod
    def between(cls, earlier: np.ndarray, later: np.ndarray) -> "SourceMotion":
        """Estimate it.

        Args:
            earlier: A frame of the source, shape [H, W, 3] uint8.
            later: A later one of the same shot and size.
        """
        views = View(earlier), View(later)
        estimate = REFERENCE_FLOW.estimate
        return cls(estimate(*views), estimate(*views[::-1]))

    @cached_property
    def steps(self) -> np.ndarray:
        """Motion of every pixel of the earlier frame [px], shape [H, W, 2] float32."""
        return dense(self.forward)

    @cached_property
    def visible(self) -> np.ndarray:
        """Pixels of the earlier frame that the later one shows as well, shape [H, W] bool."""
        return visible(self.steps, dense(self.backward))
