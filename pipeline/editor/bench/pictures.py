"""The source's pictures, any of them at once, the next one without a search."""

from collections import OrderedDict

from pipeline.options.solve_options import SolveOptions
from stages.frame import Frame
from stages.media import Decoder, FrameRange, open_decoder
from warp_kernels.errors import MediaError

MOST_BYTES = 256 << 20
"""Pictures that are kept [bytes]."""


class Pictures:
    """Decodes frames of a source; used by one thread.

    Args:
        options: Say where the source is and how it is read.
        last: Number of its last frame.
    """

    def __init__(self, options: SolveOptions, last: int) -> None:
        self._options, self._last = options, last
        self._kept: OrderedDict[int, Frame] = OrderedDict()
        self._decoder: Decoder | None = None
        self._next = -1

    def at(self, number: int) -> Frame:
        """A frame of the source.

        Args:
            number: Its number in the track; beyond a loop's seam the beginning is shown again.

        Raises:
            MediaError: If it cannot be read.
        """
        wanted = self._options.seam.picture_of(number)
        if wanted in self._kept:
            self._kept.move_to_end(wanted)
            return self._kept[wanted]
        if self._decoder is None or wanted != self._next:
            self.close()
            reach = FrameRange(wanted, max(wanted, self._last))
            self._decoder = open_decoder(self._options.source, reach, read=self._options.read)
        frame = next(self._decoder, None)
        self._next = wanted + 1
        if frame is None:
            raise MediaError(
                self._options.source, f"holds no frame {wanted}", "solve the clip again"
            )
        self._keep(wanted, frame)
        return frame

    def _keep(self, number: int, frame: Frame) -> None:
        self._kept[number] = frame
        while len(self._kept) > 1 and len(self._kept) * frame.pixels.nbytes > MOST_BYTES:
            self._kept.popitem(last=False)

    def close(self) -> None:
        """Release the source."""
        if self._decoder is not None:
            self._decoder.close()
            self._decoder = None
