"""How a source is read, where it leaves a choice."""

from dataclasses import dataclass, field
from fractions import Fraction

from stages.media.reading.limits import Limits
from warp_kernels.errors import OptionError

DECODERS = ("cpu", "cuda")
"""Who decodes films."""
MAX_RATE = 1000
"""More frames a second than anything is shown with."""


@dataclass(frozen=True)
class ReadOptions:
    """What a user chooses about a source.

    Raises:
        OptionError: If a value is impossible.
    """

    fps: Fraction | None = field(
        default=None,
        metadata={
            "help": "frames a second of stills and of what carries no times, such as 24 or "
            "30000/1001 (default: 25)",
            "metavar": "RATE",
            "group": "range",
        },
    )
    """Frames per second of what carries no times; None for 25."""
    page: int | None = field(
        default=None,
        metadata={
            "help": "which page of a TIFF or picture of a HEIF, from 1 (default: the first page, "
            "the main picture)",
            "group": "range",
        },
    )
    """Number of the page or picture in a file of several, from 1; None for the main one."""
    stream: int | None = field(
        default=None,
        metadata={
            "help": "which video stream of a file of several (default: the one players show)",
            "group": "range",
        },
    )
    """Index of the video stream; None for the one that players show."""

    limits: str | None = field(
        default=None,
        metadata={
            "help": "the most that a source may have, such as pixels=N,frames=N,streams=N; a file "
            "that has more is refused (default: pixels=100000000,frames=1000000,streams=1000)",
            "metavar": "KEY=N,...",
            "group": "range",
        },
    )
    """What is believed of a file, see `Limits.parse`; None for its defaults."""

    decoder: str = field(
        default="cpu",
        metadata={
            "help": "who decodes films: cuda takes an NVIDIA card where FFmpeg opens one, else the "
            "CPU with a note; the frames are the same",
            "choices": DECODERS,
            "group": "run",
        },
    )
    """Who decodes films, one of `DECODERS`."""

    def __post_init__(self) -> None:
        if self.decoder not in DECODERS:
            raise OptionError(f"--decoder {self.decoder}: choose from {', '.join(DECODERS)}")
        if self.fps is not None and not 0 < self.fps <= MAX_RATE:
            raise OptionError(f"--fps {self.fps}: must be above 0 and at most {MAX_RATE}; try 24")
        if self.page is not None and self.page < 1:
            raise OptionError(f"--page {self.page}: pages count from 1")
        if self.stream is not None and self.stream < 0:
            raise OptionError(f"--stream {self.stream}: streams count from 0")
        Limits.parse(self.limits)

    @property
    def most(self) -> Limits:
        """What is believed of a file."""
        return Limits.parse(self.limits)

    @property
    def rate(self) -> Fraction:
        """Frames per second of what carries no times."""
        return self.fps or Fraction(25)


AS_IT_COMES = ReadOptions()
"""Nothing chosen."""
