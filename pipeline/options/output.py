"""What is written, and how: a picture or a clip, a mesh track, or both."""

from dataclasses import dataclass, field
from pathlib import Path

from stages.exchange.exchange_options import ExchangeOptions
from stages.media.writing.encode_options import EncodeOptions


@dataclass(frozen=True)
class Output:
    """Where the result of a run goes."""

    path: Path | None = None
    """The picture or clip that is drawn; None where nothing is."""
    encode: EncodeOptions = field(default_factory=EncodeOptions)
    """How it is written."""
    exchange: ExchangeOptions = field(default_factory=ExchangeOptions)
    """How shapes are written."""
    track: Path | None = field(
        default=None,
        metadata={
            "help": "also write the mesh track, from which other looks can be drawn",
            "metavar": "FILE.mtrk",
            "group": "output",
        },
    )
    """The mesh track that is written, or None."""
    resume: bool = field(
        default=False,
        metadata={
            "help": "go on with the track of an interrupted job, to the same bits",
            "group": "output",
        },
    )
    """Whether to go on with the track if there is one."""

    @property
    def overwrite(self) -> bool:
        """Whether what stands there may be replaced."""
        return self.encode.overwrite
