"""Films that a card decodes, where FFmpeg opens one: the bits are those of the CPU.

What a film of these codecs looks like is laid down to the bit, so that it does not matter who
decodes it; of others, such as MPEG-2 and JPEG, every decoder makes its own.

Source: ITU-T H.264 and H.265; Google, VP9 Bitstream & Decoding Process Specification.
"""

from functools import cache

import av
from av.codec.hwaccel import HWAccel
from av.video.stream import VideoStream

CPU, CARD = "cpu", "cuda"
"""Who decodes."""
EXACT = frozenset({"h264", "hevc", "vp9"})
"""FFmpeg's decoders of codecs that leave nothing to choose; its one for AV1 knows no card."""
PLAIN = frozenset({"yuv420p", "yuvj420p"})
"""Formats of pixels that come back with no other change than where they lie."""


def card_for(stream: VideoStream) -> tuple[HWAccel | None, str]:
    """What decodes a stream on a card, or None and why the CPU does.

    Args:
        stream: A video stream of a file that the CPU would decode.
    """
    codec = stream.codec_context
    if codec.name not in EXACT or codec.pix_fmt not in PLAIN:
        return None, f"{codec.name} in {codec.pix_fmt} is not promised the same bits there"
    return _opened()


@cache
def _opened() -> tuple[HWAccel | None, str]:
    """Try a card, once in a process."""
    try:
        av.CodecContext.create("h264", "r", hwaccel=HWAccel(CARD))
    except (av.FFmpegError, NotImplementedError) as error:
        reason = str(getattr(error, "strerror", None) or error).lower()
        return None, f"FFmpeg opens no NVIDIA card here ({reason})"
    return HWAccel(CARD), ""
