"""What edits make of a frame's mesh, without making all of them again after each."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum

from stages.hand import Edit
from stages.hand.worked import Worked
from warp_kernels.errors import EditError

DENSE = 64
"""Latest states that are all kept: undo goes through them."""
SPARSE = 16
"""Of earlier states every so many-th is kept."""


class Basis(Enum):
    """On what a frame's edits are made."""

    FILM = "the track's frame"
    KEPT = "the frame that was kept before edits were applied"
    ANEW = "the frame solved by itself: edits with which the track was solved were undone"


@dataclass(frozen=True, eq=False)
class _Step:
    """An edit, and what was there after it."""

    edit: Edit
    worked: Worked | None  # None where it is not kept


class Replays:
    """The states of one frame's mesh, from its ground on.

    Args:
        ground: The mesh before the first edit.
    """

    def __init__(self, ground: Worked) -> None:
        self.ground = ground
        self._steps: list[_Step] = []

    def after(self, edits: Sequence[Edit]) -> Worked:
        """What a series of edits makes; those that cannot be made change nothing.

        Args:
            edits: All edits of the frame, in their order.
        """
        common = 0
        for step, edit in zip(self._steps, edits, strict=False):
            if step.edit is not edit and step.edit != edit:
                break
            common += 1
        while common and self._steps[common - 1].worked is None:
            common -= 1
        del self._steps[common:]
        worked = self._steps[-1].worked if self._steps else self.ground
        assert worked is not None
        for edit in edits[common:]:
            with suppress(EditError):  # so does a run over the whole shot, and says so
                worked = edit.apply(worked)
            self._steps.append(_Step(edit, worked))
            self._thin()
        return worked

    def _thin(self) -> None:
        """Let an old state go: from one nearby it is made again."""
        old = len(self._steps) - 1 - DENSE
        if old >= 0 and old % SPARSE:
            self._steps[old] = _Step(self._steps[old].edit, None)
