"""A recorded launch of one kernel, whose size follows the mesh."""

from collections.abc import Callable, Sequence
from typing import Any

SMALLEST_PART = 16
"""Below this many elements a second thread costs more than it saves."""
STEPS_PER_OCTAVE = 2
"""Launch sizes between a power of two and the next: a part that grows a little keeps its size."""


class Phase:
    """One recorded launch: all parts may run at once, and end before the next phase begins.

    Args:
        parts: Recorded Warp launches of one kernel, to be spread over disjoint ranges.
        set_span: Writes the range of a part, by the part's number, into device memory.
        per_element: Kernel threads per element.
        smallest_part: Elements below which a second part costs more than it saves.
        flows_on: Whether the next phase's parts look only at what the same part of this one wrote:
            then no part waits for another between the two.
    """

    def __init__(
        self,
        parts: Sequence[Any],
        set_span: Callable[[int, int, int], None],
        per_element: int,
        smallest_part: int,
        flows_on: bool = False,
    ) -> None:
        self.parts = tuple(parts)
        self.flows_on = flows_on
        self.sequences: dict[Any, Any] = {}
        """What teams captured that begins with this phase, by what they know it by."""
        self.shape = self._launch_sizes()
        self._size: tuple[int, int, int | None] = (0, 0, None)
        self._set_span = set_span
        self._per_element = per_element
        self._smallest_part = smallest_part

    def resize(
        self, count: int, *, per_element: int | None = None, threads: int | None = None
    ) -> None:
        """Spread `count` elements over the parts.

        Args:
            count: Elements.
            per_element: Kernel threads per element, if that changes.
            threads: Kernel threads of each part, if they are not for its elements: each looks at
                another thing and asks what it means for all elements of the part.
        """
        if per_element is not None:
            self._per_element = per_element
        if self._size == (count, self._per_element, threads):
            return
        self._size = (count, self._per_element, threads)
        share = max(-(-count // len(self.parts)), self._smallest_part)
        for number, part in enumerate(self.parts):
            begin = min(number * share, count) * self._per_element
            end = min((number + 1) * share, count) * self._per_element
            self._set_span(number, begin, end)
            needed = end - begin if threads is None or begin == end else threads
            part.set_dim(_launch_size(needed))
        self.shape = self._launch_sizes()

    def _launch_sizes(self) -> tuple[int, ...]:
        """Size of each part's launch, at least that of its range."""
        return tuple(int(part.bounds.size) for part in self.parts)


def _launch_size(needed: int) -> int:
    """A launch size of a coarse grid that holds `needed` threads."""
    if needed == 0:
        return 0
    step = max(1, (1 << (needed - 1).bit_length()) // (2 * STEPS_PER_OCTAVE))
    return -(-needed // step) * step
