"""Reaching a frame by its number without decoding all that come before it."""

import av

from stages.media.reading.source import VideoSource

WORTH_SEEKING = 300
"""Frames closer to the start than this are reached by decoding."""


def seek_to_frame(source: VideoSource, number: int) -> int:
    """Move a source towards a frame.

    Containers cannot seek to a frame number, only to a time, and only to key frames. The times
    of all packets up to the wanted one give its time. Where they leave any doubt, or the seek
    does not land on a known frame, nothing is skipped.

    Args:
        source: The file; no frame may have been consumed.
        number: The frame wanted, from 0.

    Returns:
        Number of the frame that the source yields next, at most `number`.
    """
    if number < WORTH_SEEKING:
        return 0
    try:
        times = _frame_times(source, number)
        if times is not None:
            source.seek(times[number])
            landed = source.first_frame().pts
            if landed in times and landed <= times[number]:
                return times.index(landed)
    except (av.FFmpegError, ValueError):
        pass
    source.reopen()
    return 0


def _frame_times(source: VideoSource, number: int) -> list[int] | None:
    """Times of the frames 0 to `number` [time base units], or None if they are in doubt."""
    source.reopen()
    times: list[int] = []
    last_dts: int | None = None
    for packet in source.container.demux(source.stream):
        if packet.size == 0:
            continue
        pts, dts = packet.pts, packet.dts
        if pts is None or dts is None or packet.is_corrupt:
            return None
        if last_dts is not None and dts <= last_dts:
            return None
        last_dts = dts
        if packet.is_discard:
            continue  # decoded for the sake of others, but not shown
        times.append(pts)
        if len(times) > number and dts > sorted(times)[number]:
            break
    times.sort()
    if len(times) <= number or len(set(times)) < len(times):
        return None
    return times
