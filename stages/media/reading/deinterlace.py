"""One whole picture for every interlaced frame."""

from collections.abc import Iterable, Iterator

import av
from av.filter import Graph
from av.filter.context import FilterContext
from av.video.frame import VideoFrame

from stages.media.reading.frame_filter import FrameFilter


def deinterlace(frames: Iterable[VideoFrame]) -> Iterator[VideoFrame]:
    """Pass frames through FFmpeg's `bwdif` from the first interlaced one on.

    Each frame gives one frame with the same pts; frames that are not flagged as interlaced keep
    their pixels. Frames of a format that the filter does not take pass unchanged.

    Args:
        frames: Decoded frames in the order in which they are shown.
    """
    weaver: FrameFilter | None = None
    for frame in frames:
        if weaver is not None and not weaver.takes(frame):
            yield from weaver.finish()
            weaver = None
        if weaver is None and frame.interlaced_frame:
            weaver = _weaver_for(frame)
        if weaver is None:
            yield frame
        else:
            yield from weaver.push(frame)
    if weaver is not None:
        yield from weaver.finish()


def _weaver_for(frame: VideoFrame) -> FrameFilter | None:
    try:
        return FrameFilter(frame, _link_bwdif)
    except (av.FFmpegError, ValueError):
        return None


def _link_bwdif(graph: Graph, source: FilterContext, sink: FilterContext) -> None:
    weave = graph.add("bwdif", "mode=send_frame:deint=interlaced")
    source.link_to(weave)
    weave.link_to(sink)
