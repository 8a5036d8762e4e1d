"""Estimates of motion between two pictures: `FLOWS` names them for the command line.

A flow is a frozen dataclass of parameters with one method
`estimate(previous [H, W, 3] uint8, current [H, W, 3] uint8) -> FlowField`; a new one is a file
and a line here. A `Passage` asks it for the motion of single points.
"""

from typing import Protocol

import numpy as np

from stages.flows.dis import Dis
from stages.flows.field import FlowField
from stages.flows.none import NoFlow


class Flow(Protocol):
    """What every member of `FLOWS` can do."""

    def estimate(self, previous: np.ndarray, current: np.ndarray) -> FlowField:
        """Estimate where the points of `previous` are in `current`, both [H, W, 3] uint8."""
        ...


FLOWS: dict[str, type[Flow]] = {
    "dis": Dis,
    "none": NoFlow,
}
