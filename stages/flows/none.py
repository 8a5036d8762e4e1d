"""No flow: every frame starts from the previous mesh as it is."""

from dataclasses import dataclass

import numpy as np

from stages.flows.field import FlowField


@dataclass(frozen=True)
class NoFlow:
    """The paper's own way to follow a video: the optimiser alone moves the vertices.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 6.3.
    """

    def estimate(self, previous: np.ndarray, current: np.ndarray) -> FlowField:
        """Return no motion, whatever the pictures [H, W, 3] uint8 show."""
        return FlowField.still(current.shape[1], current.shape[0])
