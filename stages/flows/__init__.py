"""Estimates of motion between two pictures: `FLOWS` names them for the command line.

A flow is a frozen dataclass of parameters with one method
`estimate(previous: View, current: View) -> FlowField`, which imports what it needs: the help reads
the parameters of all. A new one is a file and a line here, or a package of its own. A `Passage`
asks it for the motion of single points.
"""

from typing import TYPE_CHECKING, Protocol

from warp_kernels.registry import Registry

if TYPE_CHECKING:
    from stages.flows.field import FlowField
    from stages.flows.view import View


class Flow(Protocol):
    """What every member of `FLOWS` can do."""

    def estimate(self, previous: "View", current: "View") -> "FlowField":
        """Estimate where the points of `previous` are in `current`."""
        ...


FLOWS: Registry[Flow] = Registry(
    "flows",
    {"dis": "stages.flows.dis:Dis", "none": "stages.flows.none:NoFlow"},
    method="estimate",
)
