"""Pictures that a text holds itself, so that they go wherever the text goes."""

import base64
from functools import lru_cache

import av
import numpy as np
from av.video.codeccontext import VideoCodecContext

from stages.media.color.yuv import RgbReader, read_color
from stages.media.png_parts import picture_alone
from warp_kernels.errors import OptionError

HEAD = "data:image/png;base64,"
"""What such a text begins with: RFC 2397."""
MOST_ACROSS = 1024
"""Widest and highest picture [px]."""
MOST_LETTERS = 1 << 20
"""Longest text."""
_MOST_KEPT = 32


def is_embedded(name: str) -> bool:
    """Whether a name is a picture itself and no name of a file."""
    return name.startswith(HEAD)


def embedded(png: bytes) -> str:
    """A picture as a text.

    Args:
        png: The content of a PNG.
    """
    return HEAD + base64.b64encode(png).decode()


@lru_cache(maxsize=_MOST_KEPT)
def read_embedded(text: str) -> np.ndarray:
    """The picture that a text holds, over white where it is transparent, as that of a file is.

    Nothing of it is unpacked but the picture itself: see `png_parts`.

    Args:
        text: See `embedded`.

    Returns:
        Code values, [rows, columns, 3] uint8, which nobody changes.

    Raises:
        OptionError: If it holds none, a damaged one, or a larger one than there may be.
    """
    if len(text) > MOST_LETTERS:
        raise OptionError(
            f"a picture in an edit takes {len(text)} letters, and {MOST_LETTERS} are the most; "
            "name a file in its place"
        )
    try:
        content = base64.b64decode(text.removeprefix(HEAD), validate=True)
        pixels = _decoded(picture_alone(content, MOST_ACROSS))
    except (av.FFmpegError, ValueError) as error:
        raise OptionError(
            f"a picture in an edit is no PNG of at most {MOST_ACROSS} x {MOST_ACROSS} px in "
            "base64, or a damaged one; name a file in its place"
        ) from error
    pixels.flags.writeable = False
    return pixels


def _decoded(png: bytes) -> np.ndarray:
    """Code values, [rows, columns, 3] uint8, of a whole picture."""
    context = av.CodecContext.create("png", "r")
    assert isinstance(context, VideoCodecContext)
    (frame,) = [*context.decode(av.Packet(png)), *context.decode(None)]
    size = frame.width, frame.height
    # a copy: what shares the frame's memory keeps all that its decoder took
    return RgbReader().read8(frame, read_color(frame), size).copy()
