"""The loop over time where meshes were edited by hand: an edit reaches through its shot.

A shot is solved forwards up to its first edited frame. That frame is solved again with what the
edits hold fast, the frames before it are followed backwards from there, and the frames after it
forwards, on to the next edited frame. So a frame is final only once the next edited frame of its
shot is solved, or once there is none.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeline.envelope import MeshFrom, Prepared, Solved
from pipeline.loop.solution import followed
from pipeline.options.edit_log import EditLog
from pipeline.options.solve_options import SolveOptions
from stages.flows.passage import Passage
from stages.flows.view import View
from stages.frame import Frame
from stages.hand.worked import Worked
from stages.motion.advect import Carried
from stages.snapshot import Snapshot
from stages.triangulate import Triangulator


@dataclass(frozen=True, eq=False)
class _Found:
    """A frame that is solved but not final."""

    ready: Prepared
    """The frame."""
    snapshot: Snapshot
    """What it became so far."""


class EditedFrames:
    """Solves frames and makes the edits of a log on the way.

    Args:
        triangulator: Made for the options.
        options: Say how frames begin, and what the edits are.
        before: What the last frame of an earlier run became, or None.
        keeps: Whether what draws the frames needs their pictures.
    """

    def __init__(
        self,
        triangulator: Triangulator,
        options: SolveOptions,
        before: Snapshot | None,
        *,
        keeps: bool,
    ) -> None:
        self._triangulator, self._options = triangulator, options
        self._log = options.edits or EditLog()
        self._keeps = keeps
        self._waiting: list[_Found] = []
        self._edited: _Found | None = None  # the last edited frame of the shot
        self._snapshot = before
        self.refused: list[str] = []
        """What could not be made, one sentence for each edit."""

    def solved(self, found: Iterable[Prepared]) -> Iterator[Solved]:
        """Triangulate frame after frame; what is given is final.

        Args:
            found: The frames, and the motion between them.
        """
        shot = None
        for ready in found:
            if ready.shot != shot:
                yield from self._given()
                shot, self._edited = ready.shot, None
            self._snapshot = followed(self._triangulator, self._options, ready, self._snapshot)
            if ready.mesh_from is MeshFrom.TRACK:
                continue
            # the motion that led here is not needed again, and holds two pictures
            here = _Found(replace(ready, mesh_from=MeshFrom.LAYOUT), self._snapshot)
            self._waiting.append(here)
            if ready.frame.index in self._log.frames:
                yield from self._edit()
            elif self._log.next_frame(ready.frame.index) is None:
                yield from self._given()
        yield from self._given()

    def _given(self) -> Iterator[Solved]:
        """Hand on what waits: it is final."""
        for left, one in zip(range(len(self._waiting))[::-1], self._waiting, strict=True):
            solved = one.ready.solved(one.snapshot, keeps_picture=self._keeps)
            yield replace(solved, has_more=left > 0)
        self._waiting = []

    def _edit(self) -> Iterator[Solved]:
        """Make the edits of the frame that was solved last, and let them reach back."""
        here = self._waiting[-1]
        frame = here.ready.frame
        begun = Worked(here.snapshot.mesh, here.snapshot.locks)
        replayed = self._log.replay(frame.index, begun)
        self.refused += replayed.refused
        if replayed.worked is begun:
            return
        snapshot = self._triangulator.next(frame, Carried.by_hand(replayed.worked))
        here = _Found(here.ready, snapshot)
        earlier = self._backwards(here, self._waiting[:-1])
        self._waiting = [*earlier, here]
        here = self._resumed(here)
        self._waiting[-1] = here
        self._edited, self._snapshot = here, here.snapshot
        yield from self._given()

    def _backwards(self, edited: _Found, before: Sequence[_Found]) -> list[_Found]:
        """Follow an edited frame backwards in time.

        Args:
            edited: The frame.
            before: Those before it, in order; they are solved again.
        """
        later, again = edited, []
        view = View(later.ready.frame.pixels)
        for one in reversed(before):
            earlier = View(one.ready.frame.pixels)
            passage = Passage.between(self._options.flow, view, earlier)
            is_same = passage.is_still and _weigh_alike(one.ready.frame, later.ready.frame)
            mesh_from = MeshFrom.SAME_PICTURE if is_same else passage
            ready = replace(one.ready, mesh_from=mesh_from)
            snapshot = followed(self._triangulator, self._options, ready, later.snapshot)
            later, view = _Found(one.ready, snapshot), earlier
            again.append(later)
        return again[::-1]

    def _resumed(self, edited: _Found) -> _Found:
        """The edited frame, ready to be followed forwards: no number is given twice in a shot."""
        mesh = edited.snapshot.mesh
        meshes = [one.snapshot.mesh for one in self._waiting]
        mesh = replace(
            mesh,
            next_vertex_id=max(one.next_vertex_id for one in meshes),
            next_triangle_id=max(one.next_triangle_id for one in meshes),
        )
        snapshot = replace(edited.snapshot, mesh=mesh)
        self._triangulator.recall(edited.ready.frame, snapshot)
        return _Found(edited.ready, snapshot)


def _weigh_alike(one: Frame, other: Frame) -> bool:
    """Whether the pixels of two frames have the same weights."""
    if one.weights is None or other.weights is None:
        return one.weights is other.weights
    return np.array_equal(one.weights, other.weights)
