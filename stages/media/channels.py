"""How many channels a sound has and in which order, without freeing what FFmpeg still holds.

PyAV 18.1 hands out a copy of a stream's channel layout whose end frees what the stream still
points at, if the order is a custom one: the process then aborts. A wrapper that never ends frees
nothing, so every one that we cause is kept for ever; that is some 60 bytes each.
"""

import ctypes
from dataclasses import dataclass

from av.audio.codeccontext import AudioCodecContext
from av.audio.frame import AudioFrame


@dataclass(frozen=True)
class Channels:
    """The channels of a sound."""

    count: int
    """How many there are."""
    order: str
    """FFmpeg's name of the order, such as `5.1` or `3 channels (FR+FL+FC)`."""


def channels_of(sound: AudioCodecContext | AudioFrame) -> Channels:
    """Channels of a codec or of a decoded frame.

    Every frame that a decoder gives must pass through here, wanted or not.

    Args:
        sound: The codec or the frame.
    """
    layout = sound.layout
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(layout))
    return Channels(layout.nb_channels, layout.name)
