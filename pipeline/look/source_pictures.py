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
    wanted = {row.frame for row in rows}
    around = FrameRange(rows[0].frame, rows[-1].frame)
    with open_decoder(options.source, around, read=options.read) as decoder:
        yield from (frame.pixels for frame in decoder if frame.index in wanted)
