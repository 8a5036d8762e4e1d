"""Closing a loop: how a film is closed, and the pictures that follow its end."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from pipeline.options.seam import Seam
from pipeline.options.solve_options import SolveOptions
from stages.flows.view import View
from stages.frame import Frame
from stages.media import FrameRange, open_decoder
from stages.metrics.signature import change, signature
from warp_kernels.errors import OptionError

LEADS = 2.0
"""A film leads into itself if its last picture differs from its first by no more than so many times
what a picture differs from the next, in the median."""
NOISE = 0.5
"""And by this much beyond, which nobody sees [code values]."""


def with_seam(options: SolveOptions) -> SolveOptions:
    """The same options with what closes the loop that they ask for.

    The source alone decides, so every run over the same frames closes it in the same way.

    Args:
        options: What is wanted.

    Raises:
        OptionError: If there are too few frames, or what is wanted is no loop.
        MediaError: If the source cannot be read.
    """
    if not options.loop or options.seam.over:
        return options
    wanted, count = options.frame_range, options.loop
    if wanted.step != 1:
        raise OptionError(f"--loop {count}: takes every frame; leave x{wanted.step} out")
    if options.independent:
        raise OptionError(f"--loop {count}: with --independent no mesh leads to the next")
    first, last, is_own, earliest = _measured(options)
    length = last - first + 1
    if not is_own and first - count < earliest:
        first = earliest + count  # the film's own beginning leads over, and is not shown before
    most = (length - 1) // (1 if is_own else 2)
    if last - first + 1 <= count:
        remedy = f"choose --loop {most} or fewer" if most else "a loop needs more frames"
        raise OptionError(f"--loop {count}: there are {length} frames, too few to blend; {remedy}")
    seam = Seam(count, first, last, is_own)
    return replace(options, seam=seam, frame_range=FrameRange(*seam.solved))


def _measured(options: SolveOptions) -> tuple[int, int, bool, int]:
    """The first and the last frame, whether these are alike, and the first one of the source."""
    with open_decoder(options.source, options.frame_range, read=options.read) as decoder:
        earliest = decoder.info.first_frame
        opening, before, steps = None, None, []
        first = last = earliest
        for frame in decoder:
            seen = signature(View(frame.pixels))
            if before is None:
                opening, first = seen, frame.index
            else:
                steps.append(change(before, seen))
            before, last = seen, frame.index
    if opening is None or before is None or not steps:
        return first, last, False, earliest
    is_own = change(before, opening) <= LEADS * float(np.median(steps)) + NOISE
    return first, last, is_own, earliest


def with_return(frames: Iterable[Frame], options: SolveOptions) -> Iterator[Frame]:
    """Let a film that leads into itself go on with its first pictures, under higher numbers.

    Args:
        frames: Frames of the source.
        options: Say where the loop is closed.
    """
    seam = options.seam
    if not (seam.over and seam.is_own):
        yield from frames
        return
    end: Frame | None = None
    step = 1
    for frame in frames:
        if frame.index > seam.closes:
            break
        step = step if end is None else frame.pts - end.pts
        end = frame
        yield frame
    if end is None or end.index != seam.closes:
        return  # a part of the film that ends before
    again = FrameRange(seam.opens, seam.opens + seam.over - 1)
    with open_decoder(options.source, again, read=options.read) as decoder:
        for place, frame in enumerate(decoder):
            number, pts = seam.closes + 1 + place, end.pts + (1 + place) * step
            yield replace(frame, index=number, pts=pts, time_base=end.time_base)
