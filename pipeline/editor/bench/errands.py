"""Long work that goes on beside editing: shots that are solved again, films that are drawn."""

import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from pipeline.look.render_job import render_job
from pipeline.loop.animate import solve
from pipeline.loop.render import render
from pipeline.options.edit_log import EditLog
from pipeline.options.look import Look
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import TrackReader
from pipeline.track.replace import replace_frames
from stages.media import FrameRange
from stages.media.writing.commit import PendingFile
from stages.media.writing.encode_options import EncodeOptions
from warp_kernels.errors import OptionError, TrimotionError

Told = Callable[[int, int], None]
"""Told how many frames are done, and of how many."""


class CancelledError(TrimotionError):
    """Somebody wanted it no more; nothing was changed."""


class _Watched(Progress):
    """Tells a window of every frame, and ends the work if that is wanted.

    Args:
        told: Told of every frame.
        is_cancelled: Asked at every frame.
    """

    def __init__(self, told: Told, is_cancelled: Callable[[], bool]) -> None:
        super().__init__()
        self._told, self._is_cancelled = told, is_cancelled

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Tell of a frame."""
        if self._is_cancelled():
            raise CancelledError("cancelled; nothing was changed")
        self._told(done, total or done)


@dataclass(frozen=True)
class Shots:
    """Shots that follow each other."""

    first: int
    """Number of their first frame."""
    last: int
    """Number of their last frame."""

    def log(self, whole: EditLog) -> EditLog:
        """The edits in them."""
        return EditLog(tuple(e for e in whole.edits if self.first <= e.frame <= self.last))

    def merged(self, solved: EditLog, log: EditLog) -> EditLog:
        """With what a track is solved once these shots are solved with another log.

        Args:
            solved: With what it was solved before.
            log: The other log, of the whole track.
        """
        around = [e for e in solved.edits if not self.first <= e.frame <= self.last]
        return EditLog((*around, *self.log(log).edits))


def apply_edits(
    track: Path,
    options: SolveOptions,
    run: Run,
    shots: Shots,
    log: EditLog,
    told: Told,
    is_cancelled: Callable[[], bool],
) -> tuple[str, ...]:
    """Solve shots with the edits in force, and put their frames into the track.

    The frames without edits are kept beside the track, once: edits are made on them.

    Args:
        track: The track.
        options: How it was solved, with its source and all pictures.
        run: What the work may use.
        shots: The shots.
        log: The edits in force, of the whole track.
        told: Told of every frame.
        is_cancelled: Asked at every frame.

    Returns:
        What could not be made, one sentence each.

    Raises:
        CancelledError: If that was wanted.
        TrimotionError: As `solve` does.
    """
    wanted = FrameRange(shots.first, shots.last, options.frame_range.step)
    own = replace(options, frame_range=wanted, edits=shots.log(log))
    with tempfile.TemporaryDirectory(prefix="trimotion-") as folder:
        part = Path(folder) / "part.mtrk"
        result = solve(own, Output(track=part), run, _Watched(told, is_cancelled))
        keep_ground(track)
        with TrackReader(track) as reader:
            before = reader.header.solve.edits or EditLog()
        replace_frames(track, part, shots.first, shots.last, shots.merged(before, log))
    return result.warnings


def ground_of(track: Path) -> Path:
    """Where the frames of a track are kept as they were before any edit."""
    return track.with_name(f"{track.stem}.ground{track.suffix}")


def keep_ground(track: Path) -> None:
    """Keep the frames of a track that was solved without an edit."""
    with TrackReader(track) as reader:
        edits = reader.header.solve.edits
    if edits is None or not edits.edits:
        pending = PendingFile(ground_of(track))
        shutil.copyfile(track, pending.path)
        pending.commit()


def draw_film(
    track: Path,
    source: Path,
    look: Look,
    output: Path,
    run: Run,
    told: Told,
    is_cancelled: Callable[[], bool],
) -> tuple[str, ...]:
    """Draw the whole track.

    Args:
        track: The track.
        source: Where its source is.
        look: How it is drawn.
        output: What is written, which must not exist.
        run: What the work may use.
        told: Told of every frame.
        is_cancelled: Asked at every frame.

    Returns:
        What is noteworthy, one sentence each.

    Raises:
        CancelledError: If that was wanted.
        TrimotionError: As `render` does.
    """
    progress = _Watched(told, is_cancelled)
    with TrackReader(track) as reader:
        made = render_job(reader, FrameRange(), look, Output(output, EncodeOptions()), run, source)
        result = render(made.job, reader, made.info, progress)
    return (*made.notes, *made.warnings, *result.notes, *result.warnings)


def beside(track: Path, name: str) -> Path:
    """A file that a window names, in the folder of the track.

    Args:
        track: The track.
        name: The name.

    Raises:
        OptionError: If it is no name of a file alone.
    """
    if not name or Path(name).name != name or name.startswith(".") or not name.isprintable():
        raise OptionError(f"{name!r}: give the name of a file, such as {track.stem}.mp4")
    return track.parent / name
