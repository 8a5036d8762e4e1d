"""From decoded frames to the steps of a solution: cuts found, motion known, range exact.

Whether a shot begins with a frame depends on the source alone, not on the range that is solved:
the frames around a range are decoded as well and looked at. That is why ranges that begin with a
shot, solved one by one, are equal to the whole.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

import numpy as np

from pipeline.loop.attention import reach_of
from pipeline.loop.shots import AHEAD, ShotFrame
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


@dataclass(frozen=True, eq=False, slots=True)
class Step:
    """A frame and the motion that led to it."""

    frame: Frame
    """The frame."""
    passage: Passage | None
    """What leads here from the frame before, or None where a mesh starts anew."""
    shot: int
    """Number of the frame with which its shot begins."""
    repeats: bool = False
    """Whether picture and weights are those of the frame before."""
    before: Frame | None = None
    """The frame before, where an earlier run ended with it; else None."""


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


def steps(
    shot_frames: Iterable[ShotFrame],
    info: MediaInfo,
    options: SolveOptions,
    reached: Reached | None,
    notes: list[str],
) -> Iterator[Step]:
    """Estimate the motion between the frames of a shot.

    Args:
        shot_frames: The frames of the range and around it.
        info: The source.
        options: Say what is wanted and how motion is estimated.
        reached: Where an earlier run ended, or None.
        notes: Receives a sentence if a mesh begins inside a shot.
    """
    before: Frame | None = None
    earlier: View | None = None
    shot = None if reached is None else reached.shot
    last = None if reached is None else reached.frame
    for shot_frame in shot_frames:
        frame = shot_frame.frame
        later = View(frame.pixels)
        is_new = reached is None or frame.index > reached.frame
        if is_new and holds(options.frame_range, frame, info):
            joined = before is not None and before.index == last
            if not (joined or shot_frame.opens_shot or options.independent):
                notes.append(_restart(frame.index))
            if shot is None or shot_frame.opens_shot or not joined:
                shot = frame.index
            passage: Passage | None = None
            if earlier is not None and shot != frame.index and not options.independent:
                passage = Passage.between(options.flow, earlier, later)
            goes_on = reached is not None and last == reached.frame and joined
            repeats = _repeats(passage, before, frame)
            yield Step(frame, passage, shot, repeats, before if goes_on else None)
            last = frame.index
        before, earlier = frame, later


def _repeats(passage: Passage | None, before: Frame | None, frame: Frame) -> bool:
    """Whether a frame looks and weighs as the one before."""
    if passage is None or before is None or not passage.is_still:
        return False
    one, other = before.weights, frame.weights
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
