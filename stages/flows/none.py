"""No flow: every frame starts from the previous mesh as it is."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stages.flows.field import FlowField
    from stages.flows.view import View


@dataclass(frozen=True)
class NoFlow:
    """The paper's own way to follow a video: the optimiser alone moves the vertices.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 6.3.
    """

    def estimate(self, previous: "View", current: "View") -> "FlowField":
        """Return no motion, whatever the pictures show."""
        from stages.flows.field import FlowField

        return FlowField.still(current.width, current.height)
