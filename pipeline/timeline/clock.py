"""What time it is: seconds, frames, beats and bars of one film."""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import numpy as np

from pipeline.timeline.times import Span, Unit, When
from stages.hearing.heard import Heard
from stages.media import MediaInfo
from warp_kernels.errors import OptionError

USUAL_SIDE = 720
"""Shorter side of a film whose pixels are `px` [px]."""
USUAL_RATE = Fraction(25)
"""Frames a second of what carries no times."""
_NEAR = Fraction(1, 4)
"""A frame that is off its place at an even rate by no more than this part of a frame is shown at
that place: containers round times."""
NEAR_BAR = 0.05
"""A bar is near to a part of the film if it is no further away than this part of it."""
NO_BEAT = (
    "no beat is heard; give --audio SONG, --beats FILE with two beats or more (trimotion listen "
    "writes it), or write bpm = 120 on top"
)
"""What to say where beats are counted and there are none."""


@dataclass(frozen=True, eq=False)
class Clock:
    """The time of a film."""

    rate: Fraction
    """Frames a second."""
    first: int
    """Number of the film's first frame."""
    count: int | None
    """Frames of the film, None if unknown."""
    heard: Heard | None
    """Its beats and bars, in its own time; None where there are none."""
    pixel: float = 1.0
    """What a pixel of a film of 720 rows is in this one, by its shorter side [px]."""

    @classmethod
    def of(cls, info: MediaInfo, heard: Heard | None) -> "Clock":
        """The clock of a source.

        Args:
            info: The source.
            heard: Its beats and bars.
        """
        return cls(
            info.average_rate or USUAL_RATE,
            info.first_frame,
            info.frame_count,
            heard,
            min(info.width, info.height) / USUAL_SIDE,
        )

    @property
    def end(self) -> float | None:
        """When the film ends [s], None if unknown."""
        return None if self.count is None else float(self.count / self.rate)

    @property
    def beats(self) -> Heard:
        """Beats and bars.

        Raises:
            OptionError: If there are none.
        """
        if self.heard is None or not self.heard.has_beats:
            raise OptionError(NO_BEAT)
        return self.heard

    def time_of_frame(self, index: int, shown: Fraction | None = None) -> float:
        """When a frame is shown [s].

        Args:
            index: Its number in the source.
            shown: When the file shows it [s from the first frame]; None for an even rate.
        """
        if shown is None:
            return _even_time(index - self.first, self.rate)
        even = (index - self.first) / self.rate
        return float(even if abs(shown - even) * self.rate <= _NEAR else shown)

    def frame_at(self, time: float) -> int:
        """Number of the frame that is nearest to a time [s]."""
        return self.first + round(time * float(self.rate))

    def on_a_frame(self, time: float) -> float:
        """The time [s] of the frame that is nearest to one."""
        return self.time_of_frame(self.frame_at(time))

    def time_of(self, when: When, before: float = 0.0) -> float:
        """The time of a moment [s], not yet that of a frame.

        Args:
            when: The moment.
            before: The one before it [s].

        Raises:
            OptionError: If it counts beats or names a section and there are none, or the end is
                unknown.
        """
        if when.name:
            return self._section(when.name)
        if when.share is not None:
            if self.end is None:
                raise OptionError("the length of the source is unknown; write seconds or bars")
            time = float(when.share) * self.end
            return self._nearest_bar(time) if when.is_on_bar else time
        if when.is_relative:
            return self.later(before, when.span)
        amount = float(when.span.amount)
        if when.span.unit is Unit.BARS:
            return self.beats.time_of_bar(amount + 1, float(when.beat) + 1)
        if when.span.unit is Unit.BEATS:
            return float(self.beats.time_of_beat(amount))
        if when.span.unit is Unit.FRAMES:
            return float((when.span.amount - self.first) / self.rate)
        return amount

    def _section(self, name: str) -> float:
        """When a section of the song begins [s]: `verse`, or `verse 2` for the second of that name.

        Raises:
            OptionError: If there is none.
        """
        marks = () if self.heard is None else self.heard.sections
        first, _, count = name.rpartition(" ")
        number = int(count) if first and count.isdecimal() and len(count) < 5 else 0
        for wanted, place in ((name, 1), (first, number)):
            times = sorted(mark.time for mark in marks if mark.name.lower() == wanted)
            if 0 < place <= len(times):
                return times[place - 1]
        known = ", ".join(dict.fromkeys(mark.name for mark in marks)) or "none is named"
        raise OptionError(
            f"at {name}: the song has no such section ({known}); "
            "name it in the file that --beats gives"
        )

    def _nearest_bar(self, time: float) -> float:
        """The bar that is nearest to a time [s], or the beat, or itself if none is near."""
        bars = self.beats.time_of_bar(round(float(self.beats.bar_at(time))))
        beats = float(self.beats.time_of_beat(round(float(self.beats.beat_at(time)))))
        near = NEAR_BAR * (self.end or 0.0)
        return next((one for one in (bars, beats) if abs(one - time) <= near), time)

    def later(self, time: float, span: Span) -> float:
        """A length of time after another time [s].

        Args:
            time: The other time [s].
            span: How much later.

        Raises:
            OptionError: If it counts beats and there are none.
        """
        amount = float(span.amount)
        if span.unit is Unit.FRAMES:
            return time + amount / float(self.rate)
        if span.unit is Unit.BEATS:
            return float(self.beats.time_of_beat(self.beats.beat_at(time) + amount))
        if span.unit is Unit.BARS:
            return self.beats.time_of_bar(float(self.beats.bar_at(time)) + amount)
        return time + amount

    def name_of(self, time: float) -> str:
        """A time as people say it, for messages and tables: `0:12.50`, and its bar if it has one.

        Args:
            time: [s]; less than 0 before the film begins: `-0:01.00`.
        """
        minutes, seconds = divmod(abs(round(time, 2)), 60)
        text = f"{'-' if round(time, 2) < 0 else ''}{int(minutes)}:{seconds:05.2f}"
        bar = "" if self.heard is None or not self.heard.has_beats else self.bar_name(time)
        return f"{text} bar {bar}" if bar else text

    def bar_name(self, time: float) -> str:
        """The bar and the beat of a time, such as `9.3`; none before the first bar.

        Args:
            time: [s]
        """
        beats = self.beats
        bar = int(np.floor(float(beats.bar_at(time)) + 1e-3))
        if bar < 1:  # bars count from 1, and no other can be written
            return ""
        start = float(beats.beat_at(beats.time_of_bar(bar)))
        beat = float(beats.beat_at(time)) - start + 1
        return f"{bar}" if abs(beat - 1) < 0.02 else f"{bar}.{round(beat, 2):g}"


@lru_cache(maxsize=4096)
def _even_time(number: int, rate: Fraction) -> float:
    """When a frame is shown at an even rate [s]; many curves ask for the same one."""
    return float(number / rate)
