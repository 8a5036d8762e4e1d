"""What a timeline hears: the sound that counts, and what a file says of it."""

from dataclasses import dataclass, field
from pathlib import Path

from stages.media.writing.encode_options import sound_file

NOT_LISTENED = "none"
"""The value of `--beats` with which nothing is listened to."""


@dataclass(frozen=True)
class Hearing:
    """Where beats come from. The sound and its offset are options of how an output is written."""

    beats: str | None = field(
        default=None,
        metadata={
            "help": "beats and bars for --timeline from a file, as trimotion listen and others "
            "write them, in place of those that are heard; none to hear nothing",
            "metavar": "FILE",
            "group": "time",
        },
    )
    """A file of beats, `NOT_LISTENED`, or None for what the timeline names, or what is heard."""
    audio_mode: str = "auto"
    """As in `EncodeOptions`."""
    audio_offset: float = 0.0
    """As in `EncodeOptions` [s]."""

    @property
    def song(self) -> Path | None:
        """The sound that takes the place of the film's own, or None."""
        return sound_file(self.audio_mode)
