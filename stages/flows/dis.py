"""Dense inverse search: OpenCV's flow of the best accuracy for its cost."""

from dataclasses import dataclass

import cv2
import numpy as np

from stages.flows.field import FlowField
from stages.flows.view import View
from warp_kernels.errors import OptionError

SMALLEST = 12
"""The shortest side that the search accepts [px]; smaller pictures count as still."""


@dataclass(frozen=True)
class Effort:
    """How thoroughly the search goes about it."""

    preset: int
    """OpenCV's preset, which has the rest."""
    finest_level: int
    """The finest level of the pyramid; level n halves the pictures n times."""
    stride: int
    """Distance of the patches that are searched for [px of a level]."""
    descents: int
    """Steps of the search for each patch."""
    refinements: int
    """Steps that smooth the whole field, in each level."""


PRESETS = {
    "fast": Effort(cv2.DISOPTICAL_FLOW_PRESET_FAST, 2, stride=4, descents=16, refinements=5),
    "medium": Effort(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM, 1, stride=3, descents=25, refinements=5),
    "sharp": Effort(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM, 0, stride=5, descents=12, refinements=2),
    "fine": Effort(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM, 0, stride=3, descents=25, refinements=5),
}
"""OpenCV's own, and `sharp`: all levels, but less of everything else. Where one thing passes before
another the level of the pictures themselves tells most: a search that ends on half their size
blends the two motions over a band of several pixels."""


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

    def estimate(self, previous: View, current: View) -> FlowField:
        """Find where the points of one picture are in the next.

        Args:
            previous: The earlier picture.
            current: The later picture, of the same size.
        """
        before, after = previous.reduced(self.lines), current.reduced(self.lines)
        height, width = after.shape
        if min(height, width) < SMALLEST:
            return FlowField.still(current.width, current.height)
        effort = PRESETS[self.preset]
        search = cv2.DISOpticalFlow.create(effort.preset)
        search.setFinestScale(min(effort.finest_level, _coarsest_level((width, height))))
        search.setPatchStride(effort.stride)
        search.setGradientDescentIterations(effort.descents)
        search.setVariationalRefinementIterations(effort.refinements)
        # OpenCV's annotations leave out that the initial flow is optional.
        vectors = search.calc(before, after, None)  # type: ignore[call-overload]
        vectors *= np.array([current.width / width, current.height / height], dtype=np.float32)
        return FlowField(current.width, current.height, vectors)


def _coarsest_level(size: tuple[int, int]) -> int:
    """The coarsest pyramid level that OpenCV takes for pictures of a size [px].

    It replaces a finest level beyond this one by a guess from the width alone, which reads out
    of bounds when the picture is wide and low (OpenCV 5.0: 48 x 14 crashes).
    """
    patch = 8
    return max(0, int(min(np.log2(min(size) / patch), np.log2(max(size) / (4 * patch)) + 0.5)))
