"""Estimates of motion between two pictures: `FLOWS` names them for the command line.

A flow is a frozen dataclass of parameters with one method
`estimate(previous: View, current: View) -> FlowField`; a new one is a file and a line here. A
`Passage` asks it for the motion of single points.
"""

from typing import Protocol

from stages.flows.dis import Dis
from stages.flows.field import FlowField
from stages.flows.none import NoFlow
from stages.flows.view import View


class Flow(Protocol):
    """What every member of `FLOWS` can do."""

    def estimate(self, previous: View, current: View) -> FlowField:
        """Estimate where the points of `previous` are in `current`."""
        ...


FLOWS: dict[str, type[Flow]] = {
    "dis": Dis,
    "none": NoFlow,
}
