"""The pictures of the source beside the frames of a track."""

from collections.abc import Iterator, Sequence

import numpy as np

from pipeline.options.look import Look
from pipeline.options.solve_options import SolveOptions
from pipeline.track import FrameRow
from stages.media import FrameRange, open_decoder


def source_pictures(
    options: SolveOptions, look: Look, rows: Sequence[FrameRow]
) -> Iterator[np.ndarray | None]:
    """Decode what looks show of the source.

    Args:
        options: Say where the source is and how it is read.
        look: Says whether the picture is needed.
        rows: Frames of the track, in order.

    Yields:
        For every frame its picture, [H, W, 3] uint8, or None if no look needs it.

    Raises:
        MediaError: If the source cannot be read.
    """
    if not look.needs_source or not rows:
        yield from (None for _ in rows)
        return
    for run in runs_of(options, rows):
        around = FrameRange(run[0], run[-1])
        with open_decoder(options.source, around, read=options.read) as decoder:
            yield from (frame.pixels for frame in decoder if frame.index in set(run))


def runs_of(options: SolveOptions, rows: Sequence[FrameRow]) -> list[list[int]]:
    """Numbers of the source's pictures that rows show, in runs that are read one after the other.

    Args:
        options: Say where a loop is closed: what follows its end are its first pictures.
        rows: Frames of the track, in order, at least one.
    """
    runs: list[list[int]] = [[]]
    for number in (options.seam.picture_of(row.frame) for row in rows):
        if runs[-1] and number <= runs[-1][-1]:
            runs.append([])
        runs[-1].append(number)
    return runs
