"""A log of edits by hand, and what it makes of a mesh."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from stages.hand import DRAWN, EDITS, Edit
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

    @cached_property
    def mesh_frames(self) -> tuple[int, ...]:
        """The frames whose meshes are edited, ascending."""
        changing = (e.frame for e in self.edits if EDITS.name_of(type(e)) not in DRAWN)
        return tuple(sorted(set(changing)))

    def next_frame(self, index: int) -> int | None:
        """The first frame from a frame on whose mesh is edited, or None.

        Args:
            index: Number of the frame.
        """
        return next((frame for frame in self.mesh_frames if frame >= index), None)

    def steps(self, frame: int, worked: "Worked") -> Iterator[tuple[int, Replayed]]:
        """Make the edits of a frame, one by one.

        Args:
            frame: Number of the frame.
            worked: Its mesh.

        Yields:
            The edit's place in the log, from 1, and what the mesh is after it.
        """
        for number, edit in enumerate(self.edits, start=1):
            if edit.frame != frame:
                continue
            try:
                worked = edit.apply(worked)
            except EditError as error:
                yield number, Replayed(worked, (left_out(number, edit, error),))
            else:
                yield number, Replayed(worked)

    def replay(self, frame: int, worked: "Worked") -> Replayed:
        """Make the edits of a frame, in their order.

        Args:
            frame: Number of the frame.
            worked: Its mesh.
        """
        refused: list[str] = []
        for _, step in self.steps(frame, worked):
            worked = step.worked
            refused += step.refused
        return Replayed(worked, tuple(refused))


def left_out(number: int, edit: Edit, error: Exception) -> str:
    """What is told of an edit that cannot be made.

    Args:
        number: Its place in the log, from 1.
        edit: The edit.
        error: Why.
    """
    name = EDITS.name_of(type(edit))
    return f"edit {number} ({name} in frame {edit.frame}) was left out: {error}"
