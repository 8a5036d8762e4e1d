"""One track being edited: what any frame is now, and every change to it."""

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.edit_log.journal import EditJournal
from pipeline.editor.bench.easel import Easel
from pipeline.editor.bench.pictures import Pictures
from pipeline.editor.bench.replays import Replays
from pipeline.options.edit_log import EditLog
from pipeline.options.look import Look
from pipeline.options.solve_options import SolveOptions
from pipeline.track import TrackReader
from stages.frame import Frame
from stages.hand import Edit
from stages.hand.worked import Worked
from stages.snapshot import Snapshot
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device
from warp_kernels.errors import EditError, TrackError

MOST_FRAMES = 24
"""Frames whose edited states are kept."""
MOST_FITTED = 8
"""Meshes whose colours are kept."""


@dataclass(frozen=True, eq=False)
class Ghost:
    """What an edit would do, before it is made."""

    fresh: np.ndarray
    """Where vertices would come to be [px], [N, 2]."""
    gone: np.ndarray
    """Where vertices would vanish [px], [M, 2]."""


class Session:
    """A track, its source and its journal; used by one thread.

    Args:
        track: The track's file.
        options: How it was solved, with its source where that is now.
        device: Where kernels run.

    Raises:
        TrackError: If it holds no frame, or is damaged.
    """

    def __init__(self, track: Path, options: SolveOptions, device: Device) -> None:
        self.path, self.options = track, options
        self._reader = TrackReader(track)
        self._journal = EditJournal(track)
        if not self._reader.rows:
            raise TrackError(f"{track}: holds no frame yet; solve it again")
        self.info = self._reader.header.info
        self._frames = {row.frame: row for row in self._reader.rows}
        self._pictures = Pictures(options, max(self._frames))
        self._solved_with = self._reader.header.solve.edits or EditLog()
        self.easel = Easel(device, options, (self.info.width, self.info.height))
        self._replays: OrderedDict[tuple[int, bool], Replays] = OrderedDict()
        self._fitted: OrderedDict[tuple[int, str], tuple[Worked, Snapshot]] = OrderedDict()

    @property
    def frames(self) -> list[int]:
        """Numbers of the frames of the track, ascending."""
        return list(self._frames)

    @property
    def shots(self) -> list[int]:
        """The frames with which shots begin, ascending."""
        return list(self._reader.shots)

    @property
    def number(self) -> int:
        """Number of the last edit in force."""
        return self._journal.number

    def state(self) -> dict[str, Any]:
        """What is said of the whole job after every change."""
        log = self._journal.log
        return {
            "number": self._journal.number,
            "edits": len(log.edits),
            "edited": list(log.frames),
            "canUndo": bool(log.edits),
            "canRedo": self._journal.can_redo,
        }

    def picture(self, frame: int) -> Frame:
        """A frame's picture.

        Raises:
            EditError: If the track holds no such frame.
        """
        self._check(frame)
        return self._pictures.at(frame)

    def worked(self, frame: int) -> Worked:
        """A frame's mesh with all of its edits that are in force.

        Raises:
            EditError: If the track holds no such frame.
        """
        self._check(frame)
        edits = [edit for edit in self._journal.log.edits if edit.frame == frame]
        solved = [edit for edit in self._solved_with.edits if edit.frame == frame]
        if edits[: len(solved)] == solved:  # the track's frame has them in it
            return self._replayed(frame, edits[len(solved) :])
        return self._replayed(frame, edits, bare=True)

    def shown(self, frame: int, model: ColorModel | None = None) -> Snapshot:
        """A frame's mesh, with colours.

        Args:
            frame: Its number.
            model: The colour model; the track's if left out.

        Raises:
            EditError: If the track holds no such frame.
        """
        worked = self.worked(frame)
        model = model or self._reader.header.model
        known = self._fitted.get((frame, model.name))
        if known is None or known[0] is not worked:
            known = worked, self.easel.fitted(self.picture(frame), worked, model)
            self._fitted[frame, model.name] = known
        self._fitted.move_to_end((frame, model.name))
        while len(self._fitted) > MOST_FITTED:
            self._fitted.popitem(last=False)
        return known[1]

    def drawn(self, frame: int, look: Look) -> np.ndarray:
        """A frame as the film shows it, [rows, columns, 3 or 4] uint8.

        Args:
            frame: Its number.
            look: How it is drawn.

        Raises:
            EditError: If the track holds no such frame.
        """
        snapshot = self.shown(frame, look.fitted(self.easel.model))
        return self.easel.drawn(snapshot, self.picture(frame), look, self.time(frame))

    def time(self, frame: int) -> float:
        """When a frame is shown [s from the first one]."""
        row = self._frames[frame]
        return float(row.pts * self.info.time_base - self.info.start_time)

    def make(self, edits: Sequence[Edit], after: int | None) -> int:
        """Make edits, for good; all of them or none.

        Args:
            edits: The edits.
            after: Number of the edit that the window saw last.

        Returns:
            Number of the last edit in force.

        Raises:
            EditError: If one cannot be made.
            OutputError: If they cannot be written.
        """
        worked: dict[int, Worked] = {}
        for edit in edits:
            before = worked.get(edit.frame) or self.worked(edit.frame)
            worked[edit.frame] = edit.apply(before)
        return self._journal.append(edits, after)

    def ghost(self, edit: Edit) -> Ghost:
        """What an edit would do.

        Raises:
            EditError: If it cannot be made.
        """
        before = self.worked(edit.frame).mesh
        after = edit.apply(self.worked(edit.frame)).mesh
        is_fresh = ~np.isin(after.vertex_ids, before.vertex_ids)
        is_gone = ~np.isin(before.vertex_ids, after.vertex_ids)
        return Ghost(after.vertices[is_fresh], before.vertices[is_gone])

    def undo(self) -> Edit | None:
        """Put the last edit out of force; None if there is none."""
        return self._journal.undo()

    def redo(self) -> Edit | None:
        """Put an edit in force again; None if there is none."""
        return self._journal.redo()

    def close(self) -> None:
        """Release the files."""
        self._pictures.close()
        self._journal.close()
        self._reader.close()

    def _check(self, frame: int) -> None:
        if frame not in self._frames:
            last = max(self._frames)
            raise EditError(f"frame {frame}: the track holds frames {min(self._frames)} to {last}")

    def _replayed(self, frame: int, edits: Sequence[Edit], *, bare: bool = False) -> Worked:
        """What edits make of a frame's ground.

        Args:
            frame: Its number.
            edits: The edits.
            bare: Whether the ground is the frame before any edit, not as the track has it.
        """
        key = (frame, bare)
        if key not in self._replays:
            self._replays[key] = Replays(self._ground(frame, bare=bare))
        self._replays.move_to_end(key)
        while len(self._replays) > MOST_FRAMES:
            self._replays.popitem(last=False)
        return self._replays[key].after(edits)

    def _ground(self, frame: int, *, bare: bool) -> Worked:
        if bare:  # edits with which the track was solved were undone
            return Worked(self.easel.ground(self.picture(frame), self._reader.header.model).mesh)
        snapshot = self._reader.snapshot(frame)
        return Worked(snapshot.mesh, snapshot.locks)
