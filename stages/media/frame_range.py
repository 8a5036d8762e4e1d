"""Which frames of a source are wanted."""

import re
from dataclasses import dataclass
from fractions import Fraction

from warp_kernels.errors import OptionError

_FORM = re.compile(r"(?P<first>\d+)(?P<dash>-(?P<last>\d+)?)?(?:x(?P<step>\d+))?")
_SECONDS = re.compile(r"(\d+(?:\.\d*)?|\.\d+) *(ms|s)")
_CLOCK = re.compile(r"(?:(?:(?P<hours>\d+):)?(?P<minutes>\d+):)?(?P<seconds>\d+(?:\.\d*)?|\.\d+)")


@dataclass(frozen=True)
class FrameRange:
    """Frames by number, by time or both; a frame must meet every bound.

    Raises:
        OptionError: If a bound is negative, the range is empty or the step is below 1.
    """

    first: int = 0
    """Number of the first frame."""
    last: int | None = None
    """Number of the last frame, itself included; None for the end of the source."""
    step: int = 1
    """Every step-th frame, counted from `first`."""
    start_time: Fraction | None = None
    """Frames shown at or after this time [s from the source's first frame]."""
    end_time: Fraction | None = None
    """Frames that start at or before this time [s from the source's first frame]."""

    def __post_init__(self) -> None:
        if self.first < 0 or self.step < 1:
            raise OptionError(
                f"frames {self.first} in steps of {self.step}: frames count from 0 and steps "
                "from 1; write A-B or A-BxS"
            )
        if self.last is not None and self.last < self.first:
            raise OptionError(
                f"frames {self.first}-{self.last}: the last comes before the first; swap them"
            )
        if (
            self.start_time is not None
            and self.end_time is not None
            and self.end_time < self.start_time
        ):
            raise OptionError(
                f"times {float(self.start_time):g} to {float(self.end_time):g} s: "
                "the end comes before the start; swap them"
            )

    @classmethod
    def parse(cls, text: str, start: str | None = None, end: str | None = None) -> "FrameRange":
        """Read `A-B`, `A`, `A-` or `A-BxS`, both ends included, and times that bound it as well.

        Args:
            text: What the user wrote.
            start: Earliest time as the user wrote it, or None.
            end: Latest time, or None.

        Raises:
            OptionError: If a text has another form, or the end comes before the start.
        """
        if ":" in text:
            raise OptionError(
                f"frames {text!r}: ':' means different things in different programs; "
                "write A-B, both ends included, or A-BxS for every S-th frame"
            )
        match = _FORM.fullmatch(text.strip())
        if match is None:
            raise OptionError(f"frames {text!r}: not a range; write A-B, A, A- or A-BxS")
        first = int(match["first"])
        last = first if match["dash"] is None else int(match["last"]) if match["last"] else None
        times = (
            None if time is None else parse_time(time, name)
            for time, name in ((start, "--start"), (end, "--end"))
        )
        return cls(first, last, int(match["step"] or 1), *times)

    @property
    def is_whole(self) -> bool:
        """Whether every frame of the source is wanted."""
        return self == FrameRange()

    @property
    def is_single(self) -> bool:
        """Whether at most one frame is wanted."""
        return self.last is not None and self.first + self.step > self.last

    def holds(self, index: int, time: Fraction) -> bool:
        """Whether a frame is wanted.

        Args:
            index: Number of the frame.
            time: Its start [s from the source's first frame].
        """
        return (
            index >= self.first
            and self.is_in_step(index)
            and not self.is_past(index, time)
            and (self.start_time is None or time >= self.start_time)
        )

    def is_in_step(self, index: int) -> bool:
        """Whether a frame is one of every `step`, in the range or beyond it."""
        return (index - self.first) % self.step == 0

    def is_past(self, index: int, time: Fraction) -> bool:
        """Whether this frame and all later ones lie behind the range.

        Args:
            index: Number of the frame.
            time: Its start [s from the source's first frame].
        """
        if self.last is not None and index > self.last:
            return True
        return self.end_time is not None and time > self.end_time

    def __str__(self) -> str:
        ends = f"{self.first}-{'' if self.last is None else self.last}"
        return ends if self.step == 1 else f"{ends}x{self.step}"


def parse_time(text: str, name: str = "time") -> Fraction:
    """Read a time as seconds (`12.5`, `12.5s`, `12500ms`) or as a clock (`1:02.5`, `0:01:02.5`).

    Args:
        text: What the user wrote.
        name: The option, for the message.

    Returns:
        The time [s], exact.

    Raises:
        OptionError: If the text is neither.
    """
    told = _SECONDS.fullmatch(text.strip())
    if told is not None:  # as --audio-offset takes it
        return Fraction(told[1]) / (1000 if told[2] == "ms" else 1)
    match = _CLOCK.fullmatch(text.strip())
    if match is None:
        raise OptionError(
            f"{name} {text!r}: not a time; write seconds (12.5) or h:mm:ss (0:01:02.5)"
        )
    hours, minutes = int(match["hours"] or 0), int(match["minutes"] or 0)
    time = hours * 3600 + minutes * 60 + Fraction(match["seconds"])
    parts = ([("seconds", Fraction(match["seconds"]))] if match["minutes"] else []) + (
        [("minutes", Fraction(minutes))] if match["hours"] else []
    )
    for part, value in parts:
        if value >= 60:
            raise OptionError(
                f"{name} {text!r}: {part} of a clock go up to 59; write {_clock_of(time)}"
            )
    return time


def _clock_of(time: Fraction) -> str:
    """A time as a clock, such as 1:39 or 1:00:00.5."""
    whole, rest = divmod(time, 60)
    hours, minutes = divmod(int(whole), 60)
    seconds = f"{int(rest):02}" + f"{float(rest % 1):.3f}".lstrip("0").rstrip("0").rstrip(".")
    return f"{hours}:{minutes:02}:{seconds}" if hours else f"{minutes}:{seconds}"
