"""The loop over time where meshes were edited by hand: an edit reaches through its shot.

A shot is solved forwards up to its first edited frame. That frame is solved again with what the
edits hold fast, the frames before it are followed backwards from there, and the frames after it
forwards, on to the next edited frame. So a frame is final only once the next edited frame of its
shot is solved, or once there is none.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeline.edit_log.focus import followed_focus
from pipeline.envelope import MeshFrom, Prepared, Solved
from pipeline.loop.solution import followed
from pipeline.options.edit_log import EditLog
from pipeline.options.solve_options import SolveOptions
from stages.flows.passage import Passage
from stages.flows.view import View
from stages.frame import Frame
from stages.hand.locks import Locks
from stages.hand.worked import Worked
from stages.media.set_aside import ROOM, AsideFrame, SetAside
from stages.motion.advect import Carried
from stages.motion.meeting import Meeting
from stages.motion.painted_focus import NOTHING_PAINTED, PaintedFocus
from stages.snapshot import Snapshot
from stages.triangulate import Triangulator

FADE = 6
"""Frames before and after the middle between two edited ones in which one solution becomes the
other."""


@dataclass(frozen=True, eq=False)
class _Found:
    """A frame that is solved but not final; the motion that led to it is not needed again."""

    shot: int
    """Number of the frame with which its shot begins."""
    aside: AsideFrame
    """The frame."""
    snapshot: Snapshot
    """What it became so far."""

    def solved(self, *, keeps_picture: bool) -> Solved:
        """The frame as it goes on to the output.

        Args:
            keeps_picture: Whether a look shows the source.
        """
        source = self.aside.frame().pixels if keeps_picture else None
        return Solved(self.shot, self.snapshot, source)


class EditedFrames:
    """Solves frames and makes the edits of a log on the way.

    Args:
        triangulator: Made for the options.
        options: Say how frames begin, and what the edits are.
        before: What the last frame of an earlier run became, or None.
        focus: What was painted in its shot up to there, followed to it.
        keeps: Whether what draws the frames needs their pictures.
        room: Bytes of pictures that wait in memory for an edited frame; others wait in a file.
    """

    def __init__(
        self,
        triangulator: Triangulator,
        options: SolveOptions,
        before: Snapshot | None,
        *,
        focus: PaintedFocus = NOTHING_PAINTED,
        keeps: bool,
        room: int = ROOM,
    ) -> None:
        self._triangulator, self._options = triangulator, options
        self._log = options.edits or EditLog()
        self._keeps = keeps
        self._aside = SetAside(room)
        self._waiting: list[_Found] = []
        self._has_edited = False  # whether a frame of the shot was edited before
        self._snapshot = before
        self._before = focus
        self._focus = NOTHING_PAINTED  # as the frame that was solved last has it
        self._settled = NOTHING_PAINTED  # as the last final frame has it, followed by final frames
        self.refused: list[str] = []
        """What could not be made, one sentence for each edit."""

    def solved(self, found: Iterable[Prepared]) -> Iterator[Solved]:
        """Triangulate frame after frame; what is given is final.

        Args:
            found: The frames, and the motion between them.
        """
        try:
            shot = None
            for ready in found:
                if ready.shot != shot:
                    yield from self._given()
                    shot, self._has_edited = ready.shot, False
                    self._focus = self._settled = NOTHING_PAINTED
                yield from self._next(ready)
            yield from self._given()
        finally:
            self._aside.clear()

    def _next(self, ready: Prepared) -> Iterator[Solved]:
        """Solve the next frame of a shot, and hand on what is final by that."""
        focus = self._focus
        self._snapshot = followed(self._triangulator, self._options, ready, self._snapshot, focus)
        if ready.mesh_from is MeshFrom.TRACK:
            self._focus = self._settled = self._before
            return
        self._focus = focus.followed(self._snapshot)
        index = ready.frame.index
        self._waiting.append(_Found(ready.shot, self._aside.put(ready.frame), self._snapshot))
        if index in self._log.frames:
            yield from self._edit()
        if self._log.next_frame(index + 1) is None:
            yield from self._given()

    def _given(self) -> Iterator[Solved]:
        """Hand on what waits: it is final."""
        for left, one in zip(range(len(self._waiting))[::-1], self._waiting, strict=True):
            yield replace(one.solved(keeps_picture=self._keeps), has_more=left > 0)
        self._waiting, self._settled = [], self._focus
        self._aside.clear()

    def _edit(self) -> Iterator[Solved]:
        """Make the edits of the frame that was solved last, and let them reach back."""
        here = self._waiting[-1]
        frame = here.aside.frame()
        begun = Worked(here.snapshot.mesh, here.snapshot.locks)
        replayed = self._log.replay(frame.index, begun)
        self.refused += replayed.refused
        if replayed.worked is begun:
            return
        worked = replayed.worked
        weighed = self._focus.weighed(frame, worked.mesh, worked.focus)
        by_hand, renewed = Carried.by_hand(worked), bool(worked.focus)
        snapshot = self._triangulator.next(weighed, by_hand, renewed=renewed)
        self._focus = self._focus.followed(snapshot).with_strokes(snapshot, worked.focus)
        # what counts elsewhere than before makes other triangles, and these are not held
        made = None if worked.focus else snapshot.locks.but_for(begun.locks)
        here = replace(here, snapshot=snapshot)
        self._waiting = [*self._reached_back(here, self._waiting[:-1], made), here]
        here = self._resumed(here)
        self._waiting[-1] = here
        self._has_edited, self._snapshot = True, here.snapshot
        self._focus = followed_focus(
            self._settled, self._log, (one.snapshot for one in self._waiting)
        )
        yield from self._given()

    def _reached_back(
        self, edited: _Found, before: Sequence[_Found], made: Locks | None
    ) -> list[_Found]:
        """Let the edits of a frame reach back: to the shot's begin, or half way to others.

        Args:
            edited: The frame.
            before: Those before it that are not final, in order.
            made: What its own edits hold fast, if all else shall stay as it was solved.
        """
        if not self._has_edited:
            return self._backwards(edited, before)
        half = len(before) // 2
        fade = min(FADE, half)
        begin = half - fade
        back = self._backwards(edited, before[begin:], made)
        pairs = list(zip(before[begin:], back, strict=True))
        meetings = [
            Meeting(one.snapshot.mesh, other.snapshot.mesh) for one, other in pairs[: 2 * fade]
        ]
        shares = np.arange(1, 2 * fade + 1) / (2 * fade + 1)
        lines = _lines(meetings[fade], shares) if fade else shares
        met = [
            self._between(pair, meeting, share, line)
            for pair, meeting, share, line in zip(pairs, meetings, shares, lines, strict=False)
        ]
        return [*before[:begin], *met, *back[2 * fade :]]

    def _between(
        self, pair: tuple[_Found, _Found], meeting: Meeting, share: float, line: float
    ) -> _Found:
        """A frame that was reached from both sides, on the way from one solution to the other."""
        nearer = pair[int(share > 0.5)]
        mesh = meeting.between(share, line)
        if mesh is None:
            return nearer
        locks = pair[0].snapshot.locks.joined(pair[1].snapshot.locks).within(mesh)
        snapshot = self._triangulator.fit(nearer.aside.frame(), mesh)
        return replace(nearer, snapshot=replace(snapshot, locks=locks))

    def _backwards(
        self, edited: _Found, before: Sequence[_Found], made: Locks | None = None
    ) -> list[_Found]:
        """Follow an edited frame backwards in time.

        Args:
            edited: The frame.
            before: Those before it, in order; they are solved again.
            made: What edits of the frame hold fast, if all else shall stay as it was solved.
        """
        later, snapshot, again = edited.aside.frame(), edited.snapshot, []
        view, focus = View(later.pixels), self._focus
        for one in reversed(before):
            frame = one.aside.frame()
            earlier = View(frame.pixels)
            passage = Passage.between(self._options.flow, view, earlier)
            is_same = passage.is_still and _weigh_alike(frame, later)
            mesh_from = MeshFrom.SAME_PICTURE if is_same else passage
            ready = Prepared(one.shot, frame, mesh_from)
            snapshot = followed(self._triangulator, self._options, ready, snapshot, focus)
            if made is not None:
                snapshot = self._but_for(made, one, frame, snapshot)
            later, view, focus = frame, earlier, focus.followed(snapshot)
            again.append(replace(one, snapshot=snapshot))
        return again[::-1]

    def _but_for(self, made: Locks, one: _Found, frame: Frame, again: Snapshot) -> Snapshot:
        """What a frame was, with what edits made of it.

        Args:
            made: What the edits hold fast.
            one: The frame as it was solved forwards.
            frame: The frame itself.
            again: What it became backwards.
        """
        mesh = Meeting(one.snapshot.mesh, again.mesh).only(made)
        if mesh is None:
            return again
        snapshot = self._triangulator.fit(frame, mesh)
        locks = one.snapshot.locks.joined(again.locks).within(mesh)
        return replace(snapshot, locks=locks)

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
        self._triangulator.recall(edited.aside.frame(), snapshot)
        return replace(edited, snapshot=snapshot)


def _lines(meeting: Meeting, shares: np.ndarray) -> np.ndarray:
    """Left of which line [px] the later solution is, so that every frame changes as much.

    Args:
        meeting: The two solutions in the middle.
        shares: How much of all is changed, ascending, [N].
    """
    places, areas = meeting.spread()
    if not len(places):
        return shares
    order = np.argsort(places, kind="stable")
    lines: np.ndarray = np.interp(shares, np.cumsum(areas[order]) / areas.sum(), places[order])
    return lines


def _weigh_alike(one: Frame, other: Frame) -> bool:
    """Whether the pixels of two frames have the same weights."""
    if one.weights is None or other.weights is None:
        return one.weights is other.weights
    return np.array_equal(one.weights, other.weights)
