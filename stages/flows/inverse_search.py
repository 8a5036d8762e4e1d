"""The work of dense inverse search, by OpenCV."""

from dataclasses import dataclass

import cv2
import numpy as np

from stages.flows.field import FlowField
from stages.flows.view import View


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


EFFORTS = {
    "fast": Effort(cv2.DISOPTICAL_FLOW_PRESET_FAST, 2, stride=4, descents=16, refinements=5),
    "medium": Effort(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM, 1, stride=3, descents=25, refinements=5),
    "sharp": Effort(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM, 0, stride=5, descents=12, refinements=2),
    "fine": Effort(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM, 0, stride=3, descents=25, refinements=5),
}
"""OpenCV's own, and `sharp`: all levels, but less of everything else. Where one thing passes before
another the level of the pictures themselves tells most: a search that ends on half their size
blends the two motions over a band of several pixels."""


def search(previous: View, current: View, lines: int, preset: str, smallest: int) -> FlowField:
    """Find where the points of one picture are in the next.

    Args:
        previous: The earlier picture.
        current: The later picture, of the same size.
        lines: Length of the short side of the pictures compared [px].
        preset: One of `EFFORTS`.
        smallest: Shortest side that the search accepts [px]; smaller pictures count as still.
    """
    before, after = previous.reduced(lines), current.reduced(lines)
    height, width = after.shape
    if min(height, width) < smallest:
        return FlowField.still(current.width, current.height)
    effort = EFFORTS[preset]
    finder = cv2.DISOpticalFlow.create(effort.preset)
    finder.setFinestScale(min(effort.finest_level, _coarsest_level((width, height))))
    finder.setPatchStride(effort.stride)
    finder.setGradientDescentIterations(effort.descents)
    finder.setVariationalRefinementIterations(effort.refinements)
    # OpenCV's annotations leave out that the initial flow is optional.
    vectors = finder.calc(before, after, None)  # type: ignore[call-overload]
    vectors *= np.array([current.width / width, current.height / height], dtype=np.float32)
    return FlowField(current.width, current.height, vectors)


def _coarsest_level(size: tuple[int, int]) -> int:
    """The coarsest pyramid level that OpenCV takes for pictures of a size [px].

    It replaces a finest level beyond this one by a guess from the width alone, which reads out
    of bounds when the picture is wide and low (OpenCV 5.0: 48 x 14 crashes).
    """
    patch = 8
    return max(0, int(min(np.log2(min(size) / patch), np.log2(max(size) / (4 * patch)) + 0.5)))
