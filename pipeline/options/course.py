"""What changes meshes in the course of a film: part of what decides them."""

from bisect import bisect_right
from dataclasses import dataclass, replace

from stages.topology.refine_options import RefineOptions

Steps = tuple[tuple[int, float], ...]
"""Frames and the values that hold from them on, ascending."""


@dataclass(frozen=True)
class Course:
    """Numbers that hold from one frame to another; empty where nothing changes."""

    of_triangles: Steps = ()
    """Numbers of triangles."""
    of_error: Steps = ()
    """Bounds of the error [code values], see `RefineOptions.error`."""
    of_focus: Steps = ()
    """Factors of what `--focus` adds."""

    def refine(self, index: int, options: RefineOptions) -> RefineOptions:
        """How many triangles a frame has, and where.

        Args:
            index: Number of the frame.
            options: What holds where nothing is said.

        Raises:
            OptionError: If both do not go together.
        """
        triangles, error = _at(self.of_triangles, index), _at(self.of_error, index)
        if triangles is not None:
            options = replace(options, triangles=round(triangles))
        return options if error is None else replace(options, error=error)

    def focus(self, index: int) -> float:
        """The factor of what `--focus` adds in a frame."""
        found = _at(self.of_focus, index)
        return 1.0 if found is None else found

    def is_steady(self, one: int, other: int) -> bool:
        """Whether all is the same in two frames, by their numbers."""
        every = (self.of_triangles, self.of_error, self.of_focus)
        return all(_at(steps, one) == _at(steps, other) for steps in every)


def _at(steps: Steps, index: int) -> float | None:
    """The value that holds at a frame, or None before the first one."""
    place = bisect_right(steps, index, key=lambda step: step[0]) - 1
    return None if place < 0 else steps[place][1]
