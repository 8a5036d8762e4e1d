"""An FFmpeg filter graph that gives one frame for every frame."""

from collections import deque
from collections.abc import Callable, Iterator
from fractions import Fraction

import av
from av.filter import Graph
from av.filter.context import FilterContext
from av.video.frame import VideoFrame


class FrameFilter:
    """Frames of one size and format through a graph that may answer late.

    Filters change the clock, so times are remembered here and put back afterwards.
    """

    def __init__(
        self, frame: VideoFrame, build: Callable[[Graph, FilterContext, FilterContext], None]
    ) -> None:
        """Make the graph.

        Args:
            frame: A frame such as those that will follow.
            build: Links filters from the graph's source to its sink.

        Raises:
            av.FFmpegError: If the filters do not take such frames.
        """
        self._shape = (frame.width, frame.height, frame.format.name)
        self._times: deque[tuple[int | None, int, Fraction | None]] = deque()
        self._count = 0
        self._graph = Graph()
        source = self._graph.add_buffer(
            width=frame.width, height=frame.height, format=frame.format, time_base=Fraction(1, 25)
        )
        build(self._graph, source, self._graph.add("buffersink"))
        self._graph.configure()

    def takes(self, frame: VideoFrame) -> bool:
        """Whether the graph was made for this frame's size and format.

        Args:
            frame: The next frame.
        """
        return self._shape == (frame.width, frame.height, frame.format.name)

    def push(self, frame: VideoFrame) -> Iterator[VideoFrame]:
        """Feed a frame and take what is ready.

        Args:
            frame: The next frame; its time may be anything.
        """
        self._times.append((frame.pts, frame.duration, frame.time_base))
        frame.pts, frame.time_base = self._count, Fraction(1, 25)
        self._count += 1
        self._graph.vpush(frame)
        yield from self._pull()

    def finish(self) -> Iterator[VideoFrame]:
        """Take what is left."""
        self._graph.vpush(None)
        yield from self._pull()

    def _pull(self) -> Iterator[VideoFrame]:
        while self._times:
            try:
                frame = self._graph.vpull()
            except (av.error.BlockingIOError, EOFError):
                return
            frame.pts, frame.duration, frame.time_base = self._times.popleft()
            yield frame
