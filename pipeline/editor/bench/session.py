"""One track being edited: what any frame is now, and every change to it."""

from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.edit_log.focus import painted_in
from pipeline.edit_log.journal import EditJournal
from pipeline.edit_log.painted_regions import check_style, painted_regions
from pipeline.editor.bench.easel import MOST_ACROSS, Easel
from pipeline.editor.bench.film import SolvedFilm
from pipeline.editor.bench.live import Descent, Live
from pipeline.editor.bench.members import EVERYWHERE, Members
from pipeline.editor.bench.pictures import Pictures
from pipeline.editor.bench.replays import Basis, Replays
from pipeline.options.edit_log import EditLog
from pipeline.options.look import Look
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from stages.frame import Frame
from stages.hand import Edit
from stages.hand.worked import Worked
from stages.masks.area import Stroke
from stages.masks.region import Region
from stages.media.writing.commit import write_file
from stages.media.writing.still_writer import encode_still
from stages.snapshot import Snapshot
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device
from warp_kernels.errors import EditError, OutputError, TrimotionError
from warp_kernels.styles import Style

ANYWHERE = Run()
"""Any device, all cores."""
EDITED, SOLVED, BEFORE, LIVE = "edited", "solved", "before", "live"
VIEWS = (EDITED, SOLVED, BEFORE)
"""A frame with the edits just made, as the film has it, as it was before any edit."""
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
        run: What long work may use.

    Raises:
        TrackError: If it holds no frame, or is damaged.
    """

    def __init__(
        self, track: Path, options: SolveOptions, device: Device, run: Run = ANYWHERE
    ) -> None:
        self.path, self.options, self.run = track, options, run
        self._journal = EditJournal(track)
        self.film = SolvedFilm(track)
        self.info = self.film.info
        self._pictures = Pictures(options, self.film.frames[-1])
        self._members = Members(self.film, options)
        self._device = device
        self.live: Live | None = None
        self.easel = Easel(device, options, (self.info.width, self.info.height))
        self._replays: OrderedDict[tuple[int, Basis], Replays] = OrderedDict()
        self._fitted: OrderedDict[tuple[int, str], tuple[Worked, Snapshot]] = OrderedDict()

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
            "pending": [shots.first for shots in self.film.pending(log)],
            "canUndo": bool(log.edits),
            "canRedo": self._journal.can_redo,
            "hasGround": self.film.has_ground,
        }

    @property
    def log(self) -> EditLog:
        """The edits in force."""
        return self._journal.log

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
        solved = [edit for edit in self.film.solved_with.edits if edit.frame == frame]
        if not solved:
            return self._replayed(frame, edits, Basis.FILM)
        if self.film.has_ground:
            return self._replayed(frame, edits, Basis.KEPT)
        if edits[: len(solved)] == solved:  # the track's frame has them in it
            return self._replayed(frame, edits[len(solved) :], Basis.FILM)
        return self._replayed(frame, edits, Basis.ANEW)

    def shown(self, frame: int, model: ColorModel | None = None, view: str = EDITED) -> Snapshot:
        """A frame's mesh, with colours.

        Args:
            frame: Its number.
            model: The colour model; the track's if left out.
            view: One of `VIEWS`.

        Raises:
            EditError: If the track holds no such frame.
        """
        model = model or self.film.model
        if view != EDITED:
            self._check(frame)
            stored = self.film.snapshot(frame, before=view == BEFORE)
            if model is self.film.model:
                return stored
            worked = Worked(stored.mesh, stored.locks)
            return self.easel.fitted(self.picture(frame), worked, model)
        worked = self.worked(frame)
        if model is self.film.model and worked is self._film_ground(frame):
            return self.film.snapshot(frame)  # whose colours keep to those of the frames before
        known = self._fitted.get((frame, model.name))
        if known is None or known[0] is not worked:
            known = worked, self.easel.fitted(self.picture(frame), worked, model)
            self._fitted[frame, model.name] = known
        self._fitted.move_to_end((frame, model.name))
        while len(self._fitted) > MOST_FITTED:
            self._fitted.popitem(last=False)
        return known[1]

    def focus(self, frame: int, view: str = EDITED) -> tuple[Stroke, ...]:
        """Where was painted in a frame that errors count more.

        Args:
            frame: Its number.
            view: One of `VIEWS`, or `LIVE`.

        Raises:
            EditError: If the track holds no such frame.
        """
        self._check(frame)
        log = {BEFORE: EditLog(), SOLVED: self.film.solved_with}.get(view, self.log)
        return painted_in(log, frame, self.worked(frame).mesh)

    def prepare(self, look: Look, across: int = MOST_ACROSS) -> bool:
        """Make all that a look is drawn with.

        Args:
            look: How frames are drawn.
            across: Widest picture [px].

        Returns:
            See `Easel.prepare`.
        """
        look = self._painted(look)
        return self.easel.prepare(look, look.fitted(self.easel.model), across)

    def under(self, look: Look, style: Style) -> Look:
        """A look with a style over all that there is, regions that edits painted among it.

        Args:
            look: The look.
            style: The style.
        """
        painted = self._painted(look)
        if not painted.regions:
            return replace(look, styles=(*look.shown_styles(self.easel.model), style))
        everywhere = Region("everywhere", style, (self.film.frames[0],), (EVERYWHERE,))
        return replace(painted, regions=(*painted.regions, everywhere))

    def _painted(self, look: Look) -> Look:
        """A look with the regions that edits gave a style."""
        return painted_regions(self.log, self.film.frames).over(look)

    def compile_expected(self) -> None:
        """Compile what `prepare` found missing; in any thread, beside all else."""
        self._device.compile_expected()

    def drawn(
        self, frame: int, look: Look, view: str = EDITED, across: int = MOST_ACROSS
    ) -> np.ndarray:
        """A frame as the output shows it, [rows, columns, 3 or 4] uint8.

        Args:
            frame: Its number.
            look: How it is drawn.
            view: One of `VIEWS`.
            across: Widest picture [px].

        Raises:
            EditError: If the track holds no such frame.
        """
        look = self._painted(look)
        model = look.fitted(self.easel.model)
        if view == LIVE and self.live is not None and self.live.frame.index == frame:
            snapshot = self.easel.fitted(self.live.frame, self.live.worked, model)
        else:
            snapshot = self.shown(frame, model, EDITED if view == LIVE else view)
        picture = self.picture(frame) if look.needs_source else None
        shares = self._members.shares(look, frame, snapshot, is_edited=view in (EDITED, LIVE))
        return self.easel.drawn(snapshot, picture, look, self.film.time(frame), shares, across)

    def thumbnail(self, frame: int) -> np.ndarray:
        """A small picture of a frame of the film, [rows, columns, 3] uint8."""
        self._check(frame)
        return self.easel.thumbnail(self.film.snapshot(frame))

    def make(self, edits: Sequence[Edit], after: int | None, *, in_live: bool = False) -> int:
        """Make edits, for good; all of them or none. An optimiser at work goes on with them.

        Args:
            edits: The edits.
            after: Number of the edit that the window saw last; later ones must be of other frames.
            in_live: Whether they were pointed at in the mesh that is being optimised: then they
                must be possible there as well.

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
            check_style(edit)
        if after is not None and after != (here := self.number):
            others = self._journal.since(after)
            is_elsewhere = others is not None and worked.keys().isdisjoint(e.frame for e in others)
            after = here if is_elsewhere else after
        self._make_live(edits, in_live)
        try:
            return self._journal.append(edits, after)
        except TrimotionError:
            self.live = None  # which has them already
            raise

    def _make_live(self, edits: Sequence[Edit], in_live: bool) -> None:
        """Make edits of the mesh that is being optimised; else it begins anew, with all edits."""
        if self.live is None:
            return
        frame = self.live.frame.index
        try:
            self.live.make(edit for edit in edits if edit.frame == frame)
        except EditError:
            if in_live:
                raise
            self.live = None

    def ghost(self, edit: Edit, *, in_live: bool = False) -> Ghost:
        """What an edit would do.

        Args:
            edit: The edit.
            in_live: Whether to the mesh that is being optimised, if that is one of its frame.

        Raises:
            EditError: If it cannot be made.
        """
        live = self.live if in_live else None
        is_live = live is not None and live.frame.index == edit.frame
        worked = live.worked if live is not None and is_live else self.worked(edit.frame)
        before, after = worked.mesh, edit.apply(worked).mesh
        is_fresh = ~np.isin(after.vertex_ids, before.vertex_ids)
        is_gone = ~np.isin(before.vertex_ids, after.vertex_ids)
        return Ghost(after.vertices[is_fresh], before.vertices[is_gone])

    def optimise(self, frame: int, given: Mapping[str, float]) -> Live:
        """Take one step of the optimiser, from the frame with its edits on.

        Args:
            frame: Number of the frame.
            given: See `Descent.of`.

        Raises:
            EditError: If the track holds no such frame.
            OptionError: If a value is impossible.
        """
        course = Descent.of(self.options, given)
        if self.live is None or self.live.frame.index != frame:
            worked, picture = self.worked(frame), self.picture(frame)
            self.live = Live(self._device, self.options, picture, worked)
        self.live.step(course)
        return self.live

    def undo(self) -> Edit | None:
        """Put the last edit out of force; None if there is none."""
        self.live = None
        return self._journal.undo()

    def redo(self) -> Edit | None:
        """Put an edit in force again; None if there is none."""
        self.live = None
        return self._journal.redo()

    def close(self) -> None:
        """Release the files."""
        self._pictures.close()
        self._journal.close()
        self.film.close()

    def export(self, frame: int, look: Look, output: Path, view: str = EDITED) -> None:
        """Write a frame, as it is drawn.

        Args:
            frame: Its number.
            look: How it is drawn.
            output: A PNG, which must not exist.
            view: One of `VIEWS`.

        Raises:
            OutputError: If it is there, or cannot be written.
        """
        if output.suffix.lower() != ".png" or output.exists():
            reason = "exists already" if output.exists() else "is no name of a PNG"
            raise OutputError(output, reason, f"give another name, such as frame{frame}.png")
        write_file(output, encode_still(self.drawn(frame, look, view), "png", None))

    def renewed(self) -> None:
        """Frames of the track were replaced."""
        self.film.close()
        self.film = SolvedFilm(self.path)
        self._members = Members(self.film, self.options)
        self.live = None
        self._replays.clear()
        self._fitted.clear()

    def _check(self, frame: int) -> None:
        if frame not in self.film:
            first, last = self.film.frames[0], self.film.frames[-1]
            raise EditError(f"frame {frame}: the track holds frames {first} to {last}")

    def _replayed(self, frame: int, edits: Sequence[Edit], ground: Basis) -> Worked:
        """What edits make of a frame's ground.

        Args:
            frame: Its number.
            edits: The edits.
            ground: On what they are made.
        """
        key = (frame, ground)
        if key not in self._replays:
            self._replays[key] = Replays(self._ground(frame, ground))
        self._replays.move_to_end(key)
        while len(self._replays) > MOST_FRAMES:
            self._replays.popitem(last=False)
        return self._replays[key].after(edits)

    def _film_ground(self, frame: int) -> Worked | None:
        """A frame of the film as edits are made on it, if any were looked at."""
        known = self._replays.get((frame, Basis.FILM))
        return None if known is None else known.ground

    def _ground(self, frame: int, ground: Basis) -> Worked:
        if ground is Basis.ANEW:
            return Worked(self.easel.ground(self.picture(frame), self.film.model).mesh)
        snapshot = self.film.snapshot(frame, before=ground is Basis.KEPT)
        return Worked(snapshot.mesh, snapshot.locks)
