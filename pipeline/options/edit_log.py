"""A log of edits by hand, and what it makes of a mesh."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from stages.hand import EDITS, Edit
from warp_kernels.errors import EditError

if TYPE_CHECKING:
    from stages.hand.worked import Worked


@dataclass(frozen=True)
class Replayed:
    """What edits made of a mesh."""

    worked: "Worked"
    """The mesh and what is held of it."""
    refused: tuple[str, ...] = ()
    """What could not be made of it, one sentence for each edit; these changed nothing."""


@dataclass(frozen=True)
class EditLog:
    """Edits in the order in which they were made; a value that goes into a track.

    To undo is to leave the last edit out: what is made is a function of the mesh and the log.
    """

    edits: tuple[Edit, ...] = field(default=(), metadata={"registry": EDITS})
    """The edits, of any frames."""

    @cached_property
    def frames(self) -> tuple[int, ...]:
        """The frames that are edited, ascending."""
        return tuple(sorted({edit.frame for edit in self.edits}))

    def next_frame(self, index: int) -> int | None:
        """The first edited frame from a frame on, or None.

        Args:
            index: Number of the frame.
        """
        return next((frame for frame in self.frames if frame >= index), None)

    def replay(self, frame: int, worked: "Worked") -> Replayed:
        """Make the edits of a frame, in their order.

        Args:
            frame: Number of the frame.
            worked: Its mesh.
        """
        refused = []
        for number, edit in enumerate(self.edits, start=1):
            if edit.frame != frame:
                continue
            try:
                worked = edit.apply(worked)
            except EditError as error:
                name = EDITS.name_of(type(edit))
                refused.append(f"edit {number} ({name} in frame {frame}) was left out: {error}")
        return Replayed(worked, tuple(refused))
