"""What decides how an output is written."""

from dataclasses import dataclass, field

AUDIO_MODES = ("auto", "copy", "aac")
"""What may become of the sound."""


@dataclass(frozen=True)
class EncodeOptions:
    """How an output is written."""

    codec: str | None = field(
        default=None,
        metadata={"help": "video codec: h264, h265, av1, vp9, prores or ffv1 (by the ending)"},
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
            "copies what players of the format play",
            "choices": AUDIO_MODES,
            "flag": "audio",
        },
    )
    overwrite: bool = field(default=False, metadata={"help": "replace an existing output"})
    threads: int = 0
    """Threads of the encoder, those of the whole run; 0 for one per core."""
