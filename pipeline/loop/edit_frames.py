"""Whether the frames that were edited by hand are there."""

from dataclasses import replace

from pipeline.edit_log.painted_regions import painted_regions
from pipeline.loop.result import Animated
from pipeline.options.solve_options import SolveOptions
from stages.media import MediaInfo, count_frames
from warp_kernels.errors import OptionError

MOST_NAMED = 5
"""Frames that a message names."""


def check_edits(options: SolveOptions, info: MediaInfo) -> None:
    """Refuse edits beyond the end of a clip: they are those of another one.

    Args:
        options: What is solved.
        info: The source.

    Raises:
        OptionError: If there is such an edit.
        MediaError: If the source cannot be read.
    """
    last = max(options.edits.frames, default=0) if options.edits is not None else 0
    if last == 0 or info.kind == "sequence":
        return
    if info.frame_count is not None and last < info.frame_count:
        return
    count = count_frames(options.source, options.read)
    if last >= count:
        raise OptionError(
            f"--edits: frame {last} is edited, but {options.source} ends with frame {count - 1}; "
            "give the log of this clip, or leave out edits beyond its end"
        )


def with_unreached(options: SolveOptions, result: Animated) -> Animated:
    """What a run came to, with a note on edits of frames that were not solved, or that there are
    none, and warnings of styles that cannot be drawn.

    Args:
        options: What was solved.
        result: What it came to.
    """
    if options.edits is None:
        return result
    if not options.edits.edits:
        return replace(result, notes=(*result.notes, "--edits: holds no edit, so nothing changes"))
    result = replace(result, warnings=(*result.warnings, *painted_regions(options.edits).refused))
    wanted = options.frame_range
    last = wanted.last
    missed = [
        frame
        for frame in options.edits.frames
        if frame < wanted.first
        or (last is not None and frame > last)
        or not wanted.is_in_step(frame)
    ]
    if not missed:
        return result
    named = ", ".join(map(str, missed[:MOST_NAMED]))
    more = f" and {len(missed) - MOST_NAMED} others" if len(missed) > MOST_NAMED else ""
    note = f"edits of frame {named}{more} change nothing: frames {wanted} are solved"
    return replace(result, notes=(*result.notes, note))
