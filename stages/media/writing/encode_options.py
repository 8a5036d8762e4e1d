"""What decides how an output is written."""

from dataclasses import dataclass, field
from pathlib import Path

from warp_kernels.errors import OptionError

AUDIO_MODES = ("auto", "copy", "aac")
"""What may become of the sound."""


MOST_OFFSET = 86400.0
"""Seconds by which a sound may be moved; beyond a day a number is a mistake."""


def sound_file(mode: str) -> Path | None:
    """The file whose sound takes the place of the source's, if what `--audio` says is one.

    Args:
        mode: One of `AUDIO_MODES`, or a name.
    """
    return None if mode in AUDIO_MODES else Path(mode)


@dataclass(frozen=True)
class EncodeOptions:
    """How an output is written.

    Raises:
        OptionError: If a sound is moved that is not there, or too far.
    """

    codec: str | None = field(
        default=None,
        metadata={
            "help": "video codec: h264, h265, av1, vp9, prores or ffv1 (by the ending); on an "
            "NVIDIA card h264_nvenc, hevc_nvenc, av1_nvenc"
        },
    )
    crf: int | None = field(
        default=None,
        metadata={"help": "constant quality of the codec, smaller is better and larger"},
    )
    pixel_format: str | None = field(
        default=None,
        metadata={"help": "yuv420p plays everywhere; yuv444p keeps coloured edges sharp"},
    )
    encoder_preset: str | None = field(
        default=None,
        metadata={"help": "speed of the encoder, such as veryfast or slow for h264 and h265"},
    )
    audio: bool = field(default=True, metadata={"help": "carry the source's audio over"})
    audio_mode: str = field(
        default="auto",
        metadata={
            "help": "copy carries the source's audio packet by packet, aac makes AAC of it, auto "
            "copies what players of the format play; a file takes its place, cut or filled up to "
            "the film",
            "metavar": "auto|copy|aac|FILE",
            "flag": "audio",
        },
    )
    """One of `AUDIO_MODES`, or the name of a file whose sound takes the place of the source's."""
    audio_offset: float = field(
        default=0.0,
        metadata={
            "help": "when in the film the sound of --audio FILE begins: 2, 0.5s or 250ms; -2 "
            "leaves out its first 2 seconds",
            "metavar": "SECONDS",
            "reads": "seconds",
        },
    )
    overwrite: bool = field(default=False, metadata={"help": "replace an existing output"})
    threads: int = 0
    """Threads of the encoder, those of the whole run; 0 for one per core."""

    def __post_init__(self) -> None:
        if not abs(self.audio_offset) <= MOST_OFFSET:
            raise OptionError(
                f"--audio-offset {self.audio_offset:g}: must lie within a day; give seconds"
            )
        if self.audio_offset and self.song is None:
            raise OptionError(
                f"--audio-offset {self.audio_offset:g}: moves the sound of --audio FILE; name one"
            )

    @property
    def song(self) -> Path | None:
        """The file whose sound takes the place of the source's, or None."""
        return sound_file(self.audio_mode)
