"""Dense inverse search: OpenCV's flow of the best accuracy for its cost."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from warp_kernels.errors import OptionError

if TYPE_CHECKING:
    from stages.flows.field import FlowField
    from stages.flows.view import View

SMALLEST = 12
"""The shortest side that the search accepts [px]; smaller pictures count as still."""
PRESETS = ("fast", "medium", "sharp", "fine")
"""How thorough it may be, see `inverse_search`."""


@dataclass(frozen=True)
class Dis:
    """Dense inverse search on reduced pictures.

    The result depends on the two pictures alone, to the bit: no flow of an earlier frame starts
    the search, and the number of threads does not matter.

    Source: Kroeger et al., Fast Optical Flow using Dense Inverse Search (2016).

    Raises:
        OptionError: If the preset is unknown or `lines` below 12.
    """

    lines: int = 150
    """Length of the short side of the pictures compared [px]; larger ones are reduced."""
    preset: str = "sharp"
    """One of `PRESETS`.

    At 360 lines the mean end-point errors on two clips of known flow, and the cost on two cores,
    are: fast 0.91 and 0.69 px in 6 ms, medium 0.46 and 0.56 px in 20 ms, sharp 0.27 and 0.45 px in
    40 ms, fine 0.20 and 0.43 px in 80 ms. Half the lines at the next finer preset cost and err
    about the same. Sharp at 150 lines takes a fifth longer than medium at 180 and errs by 0.62
    and 0.68 px beside 0.82 and 0.65; but of the vertices beside what is covered it leads 47 and
    63 % astray by more than 1 px, not 68 and 65 %.
    """

    def __post_init__(self) -> None:
        if self.preset not in PRESETS:
            raise OptionError(f"no flow preset {self.preset!r}; choose from {', '.join(PRESETS)}")
        if self.lines < SMALLEST:
            raise OptionError(f"flow at {self.lines} lines; use {SMALLEST} or more")

    def estimate(self, previous: "View", current: "View") -> "FlowField":
        """Find where the points of one picture are in the next.

        Args:
            previous: The earlier picture.
            current: The later picture, of the same size.
        """
        from stages.flows.inverse_search import search

        return search(previous, current, self.lines, self.preset, SMALLEST)
