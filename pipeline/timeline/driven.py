"""One curve in one section: its value at a frame."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from pipeline.timeline.clock import Clock
from pipeline.timeline.expression import Expression
from pipeline.timeline.keyframes import Keyed
from pipeline.timeline.signals import Signals
from pipeline.timeline.targets import Kind, Slot, Target

CHUNK = 256
"""Frames whose values are worked out together."""


@dataclass(frozen=True, eq=False)
class Driven:
    """One curve in one section: its values."""

    target: Target
    """What changes."""
    slot: Slot | None
    """The member that it changes, looked up once: most of what a frame costs was that."""
    kind: Kind
    """Which values it takes."""
    course: Keyed | Expression
    """How."""
    clock: Clock
    """The time of the film."""
    span: tuple[float, float]
    """Begin and end of what `progress` runs through [s]."""
    chunks: dict[int, np.ndarray] = field(default_factory=dict)
    """Values that were worked out, by the number of their chunk."""

    def at(self, index: int, time: float, shot: int) -> Any:
        """The value at a frame.

        Args:
            index: Number of the frame.
            time: When it is shown [s].
            shot: Number of the frame with which its shot begins.

        Raises:
            OptionError: If it is no number.
        """
        if isinstance(self.course, Keyed):
            value = self.course.at(time)
            return self.kind.bounded(value) if self.kind.is_number else value
        if self.course.changes_with_shots or time != self.clock.time_of_frame(index):
            one = Signals(
                self.clock, np.array([index]), np.array([time]), np.array([shot]), self.span
            )
            return self.kind.bounded(float(self.course.at(one)[0]))
        chunk, place = divmod(index, CHUNK)
        return self.kind.bounded(float(self._chunk(chunk)[place]))

    def values(self, first: int, last: int) -> np.ndarray:
        """The numbers of an expression at all frames from one to another, unbounded, [N]."""
        parts = [self._chunk(number) for number in range(first // CHUNK, last // CHUNK + 1)]
        begin = first // CHUNK * CHUNK
        return np.concatenate(parts)[first - begin : last + 1 - begin]

    def held(self, first: int, last: int) -> str | None:
        """What is told if an expression leaves the bounds of its parameter; None if it does not.

        Args:
            first: Number of the first frame that is looked at.
            last: Number of the last one.
        """
        assert isinstance(self.course, Expression)
        if self.course.changes_with_shots:  # shots are not known before frames are drawn
            return None
        values = self.values(first, last)
        bounds = np.array([self.kind.least, self.kind.most])
        slack = 1e-6 * np.maximum(1.0, np.abs(values))
        out = (values < bounds[0] - slack) | (values > bounds[1] + slack)
        if not out.any():
            return None
        place = int(out.argmax())
        value = values[place]
        bound, word = (bounds[0], "least") if value < bounds[0] else (bounds[1], "most")
        return (
            f"{self.target} would be {value:.4g} at frame {first + place} and is held at "
            f"{bound:g}, the {word} that it takes"
        )

    def turns(self, first: int, last: int) -> set[int]:
        """Frames at which the value is of another kind than before: at keys, at bounds.

        Args:
            first: Number of the first frame that is looked at.
            last: Number of the last one.
        """
        if isinstance(self.course, Keyed):
            at = {self.clock.frame_at(time) for time in self.course.times}
            return {frame + step for frame in at for step in (-1, 0, 1)}
        values = self.values(first, last)
        ends = (self.kind.least, self.kind.most, 0.0, 1.0)
        places = [int(values.argmin()), int(values.argmax())]
        places += [int(np.abs(values - end).argmin()) for end in ends if np.isfinite(end)]
        return {first + place for place in places}

    def _chunk(self, number: int) -> np.ndarray:
        """Values of many frames at once; those of any frame do not depend on the others."""
        if number not in self.chunks:
            assert isinstance(self.course, Expression)
            frames = np.arange(number * CHUNK, (number + 1) * CHUNK)
            last = None if self.clock.count is None else self.clock.first + self.clock.count - 1
            frames = np.clip(frames, self.clock.first, last)
            times = np.array([self.clock.time_of_frame(int(index)) for index in frames])
            signals = Signals(self.clock, frames, times, np.full_like(frames, frames[0]), self.span)
            self.chunks[number] = self.course.at(signals)
        return self.chunks[number]
