"""How many channels a sound has and in which order."""

from dataclasses import dataclass

from av.audio.codeccontext import AudioCodecContext
from av.audio.frame import AudioFrame

from stages.media.reading.kept import keep


@dataclass(frozen=True)
class Channels:
    """The channels of a sound."""

    count: int
    """How many there are."""
    order: str
    """FFmpeg's name of the order, such as `5.1` or `3 channels (FR+FL+FC)`."""


def channels_of(sound: AudioCodecContext | AudioFrame) -> Channels:
    """Channels of a codec or of a decoded frame.

    Every frame that a decoder gives must pass through here, wanted or not: the wrapper of a custom
    order would free what FFmpeg still holds.

    Args:
        sound: The codec or the frame.
    """
    layout = sound.layout
    keep(layout)
    return Channels(layout.nb_channels, layout.name)
