"""The pictures of the source beside the frames of a track."""

from collections.abc import Iterator, Sequence

import numpy as np

from pipeline.job import Job
from pipeline.track import FrameRow
from stages.media import FrameRange, open_decoder


def source_pictures(job: Job, rows: Sequence[FrameRow]) -> Iterator[np.ndarray | None]:
    """Decode what looks show of the source.

    Args:
        job: Says where the source is and what looks need.
        rows: Frames of the track, in order.

    Yields:
        For every frame its picture, [H, W, 3] uint8, or None if no look needs it.

    Raises:
        MediaError: If the source cannot be read.
    """
    if not job.needs_source or not rows:
        yield from (None for _ in rows)
        return
    wanted = {row.frame for row in rows}
    around = FrameRange(rows[0].frame, rows[-1].frame)
    with open_decoder(job.source, around, read=job.read) as decoder:
        yield from (frame.pixels for frame in decoder if frame.index in wanted)
