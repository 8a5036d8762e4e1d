"""Transparency of VP8 and VP9, which FFmpeg's own decoders leave out."""

from typing import Any

import av
from av.video.codeccontext import VideoCodecContext
from av.video.stream import VideoStream

_DECODERS = {"vp8": "libvpx", "vp9": "libvpx-vp9"}
"""Decoders that read the second picture beside a frame, its transparency."""


def alpha_decoder(stream: VideoStream, max_pixels: int, threads: int) -> VideoCodecContext | None:
    """A decoder that keeps a stream's transparency.

    Args:
        stream: A video stream.
        max_pixels: Largest picture that is decoded [px].
        threads: Decoder threads, 0 for one per core.

    Returns:
        The decoder; None if the stream has no transparency, or its own decoder keeps it.
    """
    name = _DECODERS.get(stream.codec_context.name)
    stated = {key.lower(): value for key, value in stream.metadata.items()}
    if name is None or stated.get("alpha_mode") != "1" or name not in av.codecs_available:
        return None
    decoder: Any = av.CodecContext.create(name, "r")
    decoder.extradata = stream.codec_context.extradata
    decoder.options = {"max_pixels": str(max_pixels)}
    decoder.thread_count = threads
    return decoder if isinstance(decoder, VideoCodecContext) else None
