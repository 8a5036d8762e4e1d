"""How many frames a run will have, as far as can be told beforehand."""

from stages.media.frame_range import FrameRange
from stages.media.reading.info import MediaInfo


def expected_frames(wanted: FrameRange, info: MediaInfo) -> int | None:
    """Number of the source's frames in a range, or None if only decoding tells.

    Args:
        wanted: The range.
        info: The source.
    """
    last = info.last_frame
    if last is None or wanted.start_time is not None or wanted.end_time is not None:
        return None
    if wanted.last is not None:
        last = min(wanted.last, last)
    before = max(0, info.first_frame - wanted.first)
    first = wanted.first + -(-before // wanted.step) * wanted.step
    return max(0, (last - first) // wanted.step + 1)
