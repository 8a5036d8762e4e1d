"""What an earlier run left of a job's track, and the track that goes on from there."""

import os
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path

from pipeline.options.output import Output
from pipeline.options.solve_options import SolveOptions
from pipeline.track import Header, TrackReader, TrackWriter
from pipeline.track.agreement import differing_flags
from pipeline.track.header import plain_options
from pipeline.track.schema import ENDING
from stages.media import FrameRange, MediaInfo
from stages.media.writing.place import check_folder, check_name
from stages.snapshot import Snapshot
from stages.validate import InvalidMeshError, assert_valid
from warp_kernels.color_model import ColorModel
from warp_kernels.errors import OptionError, OutputError, TrackError


@dataclass(frozen=True)
class Reached:
    """The frame after which a solution goes on."""

    frame: int
    """Its number in the source."""
    shot: int
    """Number of the frame with which its shot begins."""


@dataclass(frozen=True, eq=False)
class Past:
    """The frames that a track holds already."""

    header: Header
    """How they were made."""
    reached: Reached
    """The last of them."""
    snapshot: Snapshot
    """What it became: all that the next frame depends on, beside the pictures and what a person
    painted in its shot."""
    track: Path
    """The track."""

    @property
    def notes(self) -> list[str]:
        """What may make the frames to come differ from those of an uninterrupted job."""
        other = self.header.other_versions
        return [f"the track was begun with other versions: {', '.join(other)}"] if other else []


def past_of(options: SolveOptions, output: Output, fitted: ColorModel) -> Past | None:
    """What an earlier run left.

    Args:
        options: What decides the meshes.
        output: Names the track, and says whether to go on with it.
        fitted: The colour model of the snapshots.

    Returns:
        None if there is no track, none is asked for, or it is to be replaced.

    Raises:
        OptionError: If the track was made with other options, or from other frames.
        TrackError: If it cannot be read, or was made from another source.
        OutputError: If a track cannot be written there.
    """
    path = output.track
    if path is None:
        if output.resume:
            raise OptionError("--resume: nothing is left to go on with; name a --track FILE.mtrk")
        return None
    check_track_place(path, output)
    if not (output.resume and path.exists()):
        return None
    with TrackReader(path) as reader:
        header, last = reader.header, reader.last()
        _check_agrees(path, options, fitted, header)
        if last is None:
            return None
        _check_range(path, options.frame_range, header.frame_range, last.frame)
        reader.check()
        return Past(header, Reached(last.frame, last.shot), _ground(reader, last.frame), path)


def _ground(reader: TrackReader, frame: int) -> Snapshot:
    """The frame on which the next one builds: edits take all for granted that a mesh must obey."""
    snapshot = reader.snapshot(frame)
    try:
        assert_valid(snapshot.mesh)
    except InvalidMeshError as error:
        raise TrackError(
            f"{reader.path}: frame {frame} is damaged ({error}); take a copy of the track, or "
            "solve again"
        ) from error
    return snapshot


def open_track(
    options: SolveOptions, path: Path | None, info: MediaInfo, fitted: ColorModel, past: Past | None
) -> AbstractContextManager[TrackWriter | None]:
    """Begin a track, or go on with it.

    Args:
        options: What decides the meshes.
        path: The track, or None if none is wanted.
        info: The source.
        fitted: The colour model of the snapshots.
        past: What an earlier run left.

    Returns:
        The track, or None if none is wanted.
    """
    if path is None:
        return nullcontext()
    wanted = options.frame_range
    if past is None:
        return TrackWriter(path, Header.of(options, info, fitted))
    if wanted.last is not None and wanted.last < past.reached.frame:
        return nullcontext()  # all of it is there, and more: the track stays as it is
    wanted = replace(past.header.frame_range, last=wanted.last, end_time=wanted.end_time)
    header = past.header.with_range(wanted)
    return TrackWriter.resume(path, header, past.snapshot, past.reached.shot)


def check_track_name(path: Path) -> None:
    """Refuse names that a track cannot have.

    Raises:
        OptionError: If it does not end as tracks do.
        OutputError: If its folder is not there, or something stands there that is no file.
    """
    if path.suffix.lower() != ENDING:
        raise OptionError(f"{path}: a mesh track ends in {ENDING}; choose such a name")
    check_name(path)


def check_track_place(path: Path, output: Output) -> None:
    """Find out before any work is done whether a track can be written.

    Args:
        path: The track.
        output: Says whether to go on with it, or to replace what is there.

    Raises:
        OptionError: If its name does not end as tracks do.
        TrackError: If it is to be resumed and is a folder.
        OutputError: If it exists and is neither to be resumed nor replaced, or cannot be written.
    """
    if output.resume and path.is_dir():
        raise TrackError(f"{path}: is a folder; give the name of a track")
    check_track_name(path)
    if os.path.lexists(path) and not (output.resume or output.overwrite):
        raise OutputError(path, "exists already", "choose another name, --resume or --overwrite")
    check_folder(path)


def _check_agrees(path: Path, options: SolveOptions, fitted: ColorModel, header: Header) -> None:
    """Refuse to go on in another way than the track was begun."""
    header.source.check(options.source)
    differing = differing_flags(header.options, plain_options(options))
    if fitted != header.model:
        differing.append(f"a --style of {fitted.name} colours instead of {header.model.name} ones")
    step = header.frame_range.step
    if options.frame_range.step != step:
        differing.append(f"every {options.frame_range.step}. frame instead of every {step}.")
    if differing:
        raise OptionError(
            f"--resume: {path} was begun with other options ({', '.join(differing)}); give "
            "the same, or choose another name"
        )


def _check_range(path: Path, wanted: FrameRange, had: FrameRange, last: int) -> None:
    """Refuse ranges that would leave a gap before the track's frames or be out of step."""
    if (wanted.first, wanted.start_time) == (had.first, had.start_time):
        return
    if wanted.first < had.first or wanted.first > last + had.step:
        raise OptionError(
            f"--resume --frames {wanted}: {path} holds frames {had.first} to {last}; go on with "
            f"--frames {last + had.step}- or solve the range to another track and join them"
        )
    if (wanted.first - had.first) % had.step:
        raise OptionError(
            f"--resume --frames {wanted}: {path} holds frames {had}; stay in step with them"
        )
