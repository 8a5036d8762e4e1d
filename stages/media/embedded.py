"""Pictures that a text holds itself, so that they go wherever the text goes."""

import base64
import binascii
from functools import lru_cache

import av
import numpy as np
from av.video.codeccontext import VideoCodecContext

from warp_kernels.errors import OptionError

HEAD = "data:image/png;base64,"
"""What such a text begins with: RFC 2397."""
MOST_ACROSS = 1024
"""Widest and highest picture [px]."""
MOST_LETTERS = 1 << 20
"""Longest text."""
_BEGIN = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"
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
    """The picture that a text holds.

    Args:
        text: See `embedded`.

    Returns:
        Code values, [rows, columns, 3] uint8, which nobody changes.

    Raises:
        OptionError: If it holds none, or a larger one than there may be.
    """
    problem = OptionError(
        f"a picture in an edit is no PNG of at most {MOST_ACROSS} x {MOST_ACROSS} px in base64; "
        "name a file in its place"
    )
    if len(text) > MOST_LETTERS:
        raise problem
    try:
        content = base64.b64decode(text.removeprefix(HEAD), validate=True)
    except (binascii.Error, ValueError) as error:
        raise problem from error
    size = [int.from_bytes(content[at : at + 4], "big") for at in (16, 20)]
    if not content.startswith(_BEGIN) or not all(0 < side <= MOST_ACROSS for side in size):
        raise problem
    try:
        context = av.CodecContext.create("png", "r")
        assert isinstance(context, VideoCodecContext)
        (frame,) = [*context.decode(av.Packet(content)), *context.decode(None)]
        pixels = frame.to_ndarray(format="rgb24")
    except (av.FFmpegError, ValueError) as error:
        raise problem from error
    pixels.flags.writeable = False
    return pixels
