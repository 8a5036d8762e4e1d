"""Which frames of a track those of a range depend on when they are drawn."""

from collections.abc import Sequence

from pipeline.look.smooth import reach_of
from pipeline.options.look import Look
from pipeline.options.solve_options import SolveOptions
from pipeline.track import FrameRow


def rows_around(
    rows: Sequence[FrameRow], shown: Sequence[FrameRow], options: SolveOptions, look: Look
) -> list[FrameRow]:
    """The frames of a range, with those around them that they depend on.

    These are of the shots with which the range begins and ends, and in step with it: a part of a
    track looks as it does in the whole.

    Args:
        rows: All frames of the track.
        shown: Those of the range, at least one.
        options: Say which frames are in step, and whether they have anything in common.
        look: Says over how many frames triangles fade in and paths are smoothed, and whether
            strokes or the colours of a palette go on from frame to frame.
    """
    around = reach_of(look.smooth)
    in_step = [row for row in rows if options.frame_range.is_in_step(row.frame)]
    first, last = (in_step.index(row) for row in (shown[0], shown[-1]))
    begin, end = max(0, first - around - look.blend), last + around + 1
    if (look.lays_strokes or look.holds_colors) and not options.independent:
        begin = 0  # strokes are where the shot's first frame and all motion since have put them
    before = [row for row in in_step[begin:first] if row.shot == shown[0].shot]
    after = [row for row in in_step[last + 1 : end] if row.shot == shown[-1].shot]
    return [*before, *shown, *after]
