"""256 colours chosen anew for every picture of a GIF."""

from collections.abc import Iterator

from av.filter import Graph
from av.filter.context import FilterContext
from av.video.frame import VideoFrame

from stages.media.reading.frame_filter import FrameFilter


class PaletteFilter:
    """RGB frames to palette frames, one for one."""

    def __init__(self) -> None:
        """Wait for the first frame."""
        self._filter: FrameFilter | None = None

    def push(self, frame: VideoFrame) -> Iterator[VideoFrame]:
        """Feed a frame and take what is ready.

        Args:
            frame: An RGB or RGBA frame, of the same size as those before.
        """
        if self._filter is None:
            self._filter = FrameFilter(frame, _link_palette)
        yield from self._filter.push(frame)

    def finish(self) -> Iterator[VideoFrame]:
        """Take what is left."""
        if self._filter is not None:
            yield from self._filter.finish()


def _link_palette(graph: Graph, source: FilterContext, sink: FilterContext) -> None:
    split = graph.add("split")
    choose = graph.add("palettegen", "stats_mode=single:reserve_transparent=0")
    apply = graph.add("paletteuse", "new=1:dither=bayer:bayer_scale=4")
    source.link_to(split)
    split.link_to(apply, 0, 0)
    split.link_to(choose, 1, 0)
    choose.link_to(apply, 0, 1)
    apply.link_to(sink)
