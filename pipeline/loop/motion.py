"""From the frames of a source to those that are solved: motion known, range exact.

Whether a shot begins with a frame depends on the source alone, not on the range that is solved:
the frames around a range are decoded as well and looked at. That is why ranges that begin with a
shot, solved one by one, are equal to the whole.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np

from pipeline.envelope import InShot, MeshFrom, Prepared
from pipeline.loop.attention import reach_of
from pipeline.loop.shots import AHEAD
from pipeline.options.solve_options import SolveOptions
from pipeline.track import refuse_track
from pipeline.track.cuts import read_cuts
from pipeline.track.resume import Reached
from stages.flows.passage import Passage
from stages.flows.view import View
from stages.frame import Frame
from stages.media import Decoder, FrameRange, MediaInfo, count_frames, input_pattern, open_decoder
from warp_kernels.errors import MediaError

BEFORE = AHEAD + 2
"""Frames decoded before the first one that is wanted: as many as a decision about a cut looks
at, and one more for the deinterlacer."""


def open_around(options: SolveOptions, reached: Reached | None) -> Decoder:
    """Open a source for a range and the frames around it.

    Args:
        options: Say what is wanted.
        reached: Where an earlier run ended, or None. Its frame is given again: motion leads from
            its picture to the next.

    Raises:
        MediaError: If the source cannot be read.
    """
    refuse_track(options.source)
    wanted = options.frame_range
    before, after = reach_of(options.foci)
    if reached is not None and reached.frame >= wanted.first - before * wanted.step:
        last = None if wanted.last is None else max(wanted.last, reached.frame)
        # what its weights depend on is decoded again as well, but only then: a range that begins
        # inside a shot starts anew there
        first = min(wanted.first, reached.frame) if before else reached.frame
        wanted = replace(wanted, first=first, last=last)
        if input_pattern(options.source) is not None:  # whose margin costs no memory, and has gaps
            margin = (BEFORE + before, AHEAD + after)
            return open_decoder(options.source, wanted, margin=margin, read=options.read)
        back = wanted.step * min(before, first // wanted.step)
        if back:
            wanted = replace(wanted, first=first - back, start_time=None)
    margin = (BEFORE, AHEAD + after)
    return open_decoder(options.source, wanted, margin=margin, read=options.read)


def with_motion(
    frames: Iterable[InShot],
    info: MediaInfo,
    options: SolveOptions,
    reached: Reached | None,
    notes: list[str],
) -> Iterator[Prepared]:
    """Estimate the motion between the frames of a shot, and leave out those around the range.

    Args:
        frames: The frames of the range and around it.
        info: The source.
        options: Say what is wanted and how motion is estimated.
        reached: Where an earlier run ended, or None. If the solution goes on from there, that frame
            is given once more before the first one.
        notes: Receives a sentence if a mesh begins inside a shot.
    """
    before: Frame | None = None
    earlier: View | None = None
    shot = None if reached is None else reached.shot
    last = None if reached is None else reached.frame
    for seen in frames:
        frame = seen.frame
        later = View(frame.pixels) if seen.view is None else seen.view
        is_new = reached is None or frame.index > reached.frame
        if is_new and holds(options.frame_range, frame, info):
            joined = before is not None and before.index == last
            if not (joined or seen.opens_shot or options.independent):
                notes.append(_restart(frame.index))
            if reached is not None and before is not None and before.index == reached.frame == last:
                yield Prepared(reached.shot, before, MeshFrom.TRACK)
            if shot is None or seen.opens_shot or not joined:
                shot = frame.index
            mesh_from: Passage | MeshFrom = MeshFrom.LAYOUT
            if before is not None and earlier is not None and shot != frame.index:
                mesh_from = _mesh_from(options, before, frame, earlier, later)
            yield Prepared(shot, frame, mesh_from)
            last = frame.index
        before, earlier = frame, later


def _mesh_from(
    options: SolveOptions, before: Frame, frame: Frame, earlier: View, later: View
) -> Passage | MeshFrom:
    """Where the mesh of a frame comes from within a shot.

    A picture that comes again, as in what is drawn for every other frame, keeps its mesh; under
    maps, which may change meanwhile, only its motion is known.
    """
    if options.independent:
        return MeshFrom.LAYOUT
    passage = Passage.between(options.flow, earlier, later)
    is_steady = options.course.is_steady(before.index, frame.index)
    is_same = (
        passage.is_still
        and is_steady
        and not options.maps
        and _weigh_alike(before.weights, frame.weights)
    )
    return MeshFrom.SAME_PICTURE if is_same else passage


def _weigh_alike(one: np.ndarray | None, other: np.ndarray | None) -> bool:
    """Whether two weights of the pixels are the same."""
    return one is other or (one is not None and other is not None and np.array_equal(one, other))


def holds(wanted: FrameRange, frame: Frame, info: MediaInfo) -> bool:
    """Whether a frame of a source is wanted."""
    return wanted.holds(frame.index, _time(frame, info))


def check_cuts(cuts: str, source: Path, info: MediaInfo) -> None:
    """Refuse a list of cuts that goes beyond the clip: it is that of another one.

    Args:
        cuts: `auto`, `none` or the name of a list.
        source: The source.
        info: Its properties.

    Raises:
        MediaError: If the list cannot be read or names frames that there are not.
    """
    if cuts in ("auto", "none"):
        return
    last = max(read_cuts(Path(cuts)), default=0)
    if info.frame_count is not None and last < info.frame_count and info.kind != "sequence":
        return
    count = count_frames(source)
    if last >= count:
        raise MediaError(
            cuts,
            f"a cut at frame {last}, and {source} ends with frame {count - 1}",
            "give the list of this clip, or remove the cuts beyond its end",
        )


def _time(frame: Frame, info: MediaInfo) -> Fraction:
    """When a frame is shown [s from the source's first frame]."""
    return frame.pts * frame.time_base - info.start_time


def _restart(frame: int) -> str:
    return (
        f"frame {frame} is inside a shot, and a new mesh starts with it: to go on seamlessly "
        "solve whole shots (trimotion plan), or the frames before it and then --resume"
    )
