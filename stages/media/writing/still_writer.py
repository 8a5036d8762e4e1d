"""One still picture, or numbered ones."""

from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from av.video.codeccontext import VideoCodecContext

from stages.media.color.yuv import YuvWriter, over_paper
from stages.media.reading.container import DAMAGE
from stages.media.writing.commit import output_error, write_file
from stages.media.writing.output_plan import OutputPlan
from warp_kernels.errors import OutputError

_CODECS = {
    ".png": "png",
    ".jpg": "mjpeg",
    ".jpeg": "mjpeg",
    ".tif": "tiff",
    ".tiff": "tiff",
    ".webp": "libwebp",
}
_JPEG_SCALE = 2
"""Quantiser of a JPEG when none is asked for; 1 is best, 31 worst."""


class StillWriter:
    """Writes every picture as a file of its own; each appears only when it is complete."""

    def __init__(self, plan: OutputPlan, crf: int | None) -> None:
        """Prepare.

        Args:
            plan: The checked output.
            crf: Quality of JPEG and WebP, 0 (best) to 51; None for very good JPEG, lossless WebP.
        """
        self.notes: list[str] = []
        """Choices that were made, one sentence each."""
        self._plan = plan
        self._crf = crf
        ending = plan.pattern.ending if plan.pattern else plan.path.suffix.lower()
        self._codec = _CODECS[ending]
        self._content: bytes | None = None

    def write(self, pixels: np.ndarray, number: int) -> None:
        """Write a picture, or keep it until `close` when there is only one.

        Args:
            pixels: Code values, [H, W, 3] or [H, W, 4] uint8.
            number: Its frame number, for the name.

        Raises:
            OutputError: If it cannot be written, or is a second one for a single still.
        """
        plan = self._plan
        if plan.pattern is None and self._content is not None:
            raise OutputError(
                plan.path, "one still cannot hold a second frame", "write name_####.png instead"
            )
        try:
            content = encode_still(pixels, self._codec, self._crf)
        except DAMAGE as error:
            raise output_error(plan.path, error) from error
        if plan.pattern is not None:
            write_file(plan.pattern.path_for(number), content)
        self._content = content

    def close(self) -> None:
        """Write the single still.

        Raises:
            OutputError: If it cannot be written.
        """
        if self._plan.pattern is None and self._content is not None:
            write_file(self._plan.path, self._content)

    def abort(self) -> None:
        """Nothing to remove: numbered stills that were written are complete."""


def encode_still(pixels: np.ndarray, codec: str, crf: int | None) -> bytes:
    """Encode one picture.

    Args:
        pixels: Code values, [H, W, 3] or [H, W, 4] uint8.
        codec: FFmpeg's encoder: `png`, `tiff`, `mjpeg` or `libwebp`.
        crf: Quality of mjpeg and libwebp, 0 (best) to 51; None for the default.

    Raises:
        av.FFmpegError: If the encoder refuses.
    """
    if codec == "mjpeg" and pixels.shape[2] == 4:
        pixels = over_paper(pixels)
    context = av.CodecContext.create(codec, "w")
    if not isinstance(context, VideoCodecContext):
        raise ValueError(f"{codec} is no picture encoder")
    context.height, context.width = pixels.shape[:2]
    context.time_base = Fraction(1, 25)
    pixel_format = _still_format(codec, pixels.shape[2], crf)
    context.pix_fmt = pixel_format
    if codec == "mjpeg":
        scale = _JPEG_SCALE if crf is None else max(1, round(crf * 31 / 51))
        context.qmin = context.qmax = scale
        context.color_range = 2
    if codec == "libwebp":
        lossless = {"lossless": "1"} if crf is None else {"quality": str(100 - crf * 100 // 51)}
        context.options = lossless
    frame = YuvWriter(pixel_format).write(pixels)
    frame.pts = 0
    packets = [*context.encode(frame), *context.encode(None)]
    return b"".join(bytes(packet) for packet in packets)


def _still_format(codec: str, channels: int, crf: int | None) -> str:
    if codec == "mjpeg":
        return "yuvj444p"
    if codec == "libwebp" and crf is None:
        return "bgra"
    if codec == "libwebp":
        return "yuva420p" if channels == 4 else "yuv420p"
    return "rgba" if channels == 4 else "rgb24"


def write_picture(path: Path, pixels: np.ndarray) -> None:
    """Write one picture as a still.

    Args:
        path: The file; its ending is one of `STILL_ENDINGS`.
        pixels: Code values, [H, W, 3] uint8.

    Raises:
        OutputError: If it cannot be written.
    """
    try:
        content = encode_still(pixels, _CODECS[path.suffix.lower()], None)
    except DAMAGE as error:
        raise output_error(path, error) from error
    write_file(path, content)
