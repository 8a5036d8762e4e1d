"""What expressions may look at: numbers for some frames at once."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from pipeline.timeline.clock import Clock
from pipeline.timeline.times import Span, Unit
from stages.hearing.heard import Heard
from warp_kernels.errors import OptionError

STRENGTHS = {"rms": "loudness", "low": "low", "mid": "mid", "high": "high"}
"""Strengths of the sound by variable, and their names among what is heard."""
EVENTS = {"beat": "beats", "downbeat": "downbeats", "onset": "onsets"}
"""Moments by variable, and their names among what is heard."""
NUMBERS = ("t", "f", "b", "bar", "bpm", "shot", "progress", "px")
"""Variables that are no strengths and no moments."""
VARIABLES = (*NUMBERS, *STRENGTHS, *EVENTS)
"""All variables."""
MOST_STEPS = 2000
"""Places on either side of a frame at which a smoothed strength is looked at."""
NEVER = np.inf
"""How long ago a moment was that has not come yet [s]."""


@dataclass(frozen=True, eq=False)
class Signals:
    """Some frames, and what is known of them."""

    clock: Clock
    """The time of the film."""
    frames: np.ndarray
    """Their numbers, [N] int64."""
    times: np.ndarray
    """When they are shown [s], [N] float64."""
    shots: np.ndarray
    """Numbers of the frames with which their shots begin, [N] int64."""
    span: tuple[float, float]
    """Begin and end of what `progress` runs through [s]."""

    def some(self, chosen: np.ndarray) -> "Signals":
        """Some of the frames.

        Args:
            chosen: Which, [N] bool.
        """
        return replace(
            self, frames=self.frames[chosen], times=self.times[chosen], shots=self.shots[chosen]
        )

    @property
    def half(self) -> float:
        """Half of the time that a frame is shown [s]."""
        return 0.5 / float(self.clock.rate)

    @property
    def _late(self) -> np.ndarray:
        """Half a frame later, but for what belongs to the next frame [s], [N]."""
        return self.times + self.half - 1e-9

    def value(self, name: str) -> np.ndarray:
        """A variable, [N] float64.

        Args:
            name: One of `VARIABLES`.

        Raises:
            OptionError: If nothing is heard that it tells of.
        """
        if name in STRENGTHS:
            return self.strength(name)
        if name in EVENTS:
            return self.strikes(self.since(name))
        if name == "progress":
            begin, end = self.span
            return np.clip((self.times - begin) / max(end - begin, 1e-9), 0.0, 1.0)
        if name == "px":
            return np.full_like(self.times, self.clock.pixel)
        if name == "bpm":
            beats = self.clock.beats
            around = [np.asarray(beats.time_of_beat(self.value("b") + d)) for d in (-0.5, 0.5)]
            return 60.0 / (around[1] - around[0])
        found = {"t": self.times, "f": self.frames, "shot": self.shots}.get(name)
        if found is not None:
            return np.asarray(found, dtype=float)
        place = self.clock.beats.beat_at if name == "b" else self.clock.beats.bar_at
        now, soon = (np.asarray(place(times)) for times in (self.times, self._late))
        # a beat that comes before half of the frame is over is there already, as for `beat`
        return np.maximum(now, np.floor(soon))

    def strength(self, name: str, smooth: float = 0.0) -> np.ndarray:
        """How strong the sound is, 0 to 1, [N] float64.

        Args:
            name: One of `STRENGTHS`.
            smooth: Over how much time the mean is taken, around every frame [s].
        """
        envelope = self._heard.envelope(STRENGTHS[name])
        if smooth <= 0.0:
            return np.asarray(envelope.at(self.times))
        half = min(max(2, round(smooth * envelope.rate / 2)), MOST_STEPS)
        steps = np.linspace(-0.5, 0.5, 2 * half + 1)
        weights = 1.0 + np.cos(2 * np.pi * steps)
        spread = np.asarray(envelope.at(self.times[:, None] + smooth * steps))
        return np.asarray((spread * weights).sum(axis=1) / weights.sum())

    def since(self, name: str) -> np.ndarray:
        """How long ago the last moment of a kind was [s], [N]; 0 in the frame nearest to it.

        Args:
            name: One of `EVENTS`, or `shot`.
        """
        if name == "shot":
            return (self.frames - self.shots) / float(self.clock.rate)
        heard = self.clock.beats if name != "onset" else self._heard
        return self._ago(np.asarray(heard.since(EVENTS[name], self._late)))

    def since_every(self, span: Span) -> np.ndarray:
        """How long ago one of evenly spaced moments was [s], [N], counted from the film's start.

        Args:
            span: From one to the next.

        Raises:
            OptionError: If it is 0.
        """
        amount = float(span.amount)
        if amount <= 0:
            raise OptionError(f"every({span}): must be above 0; write every(1 beat)")
        late = self._late
        if span.unit is Unit.BEATS:
            beats = self.clock.beats
            place = np.floor(np.asarray(beats.beat_at(late)) / amount) * amount
            return self._ago(late - np.asarray(beats.time_of_beat(place)))
        if span.unit is Unit.BARS:
            beats = self.clock.beats
            places = np.floor((np.asarray(beats.bar_at(late)) - 1) / amount) * amount + 1
            return self._ago(late - np.array([beats.time_of_bar(float(one)) for one in places]))
        step = amount if span.unit is Unit.SECONDS else amount / float(self.clock.rate)
        return self._ago(late - np.floor(late / step) * step)

    def strikes(self, since: np.ndarray) -> np.ndarray:
        """1 in the frames in which a moment is, 0 in others, [N].

        Args:
            since: How long ago it was [s], [N].
        """
        return (since < self.half).astype(float)

    def seconds(self, span: Span) -> np.ndarray | float:
        """A length of time at each frame [s]: one of beats changes with the tempo.

        Args:
            span: The length.
        """
        if not span.unit.needs_beats:
            return self.clock.later(0.0, span)
        return np.array([self.clock.later(float(time), span) - time for time in self.times])

    def _ago(self, since: np.ndarray) -> np.ndarray:
        """How long before the frame in which it is shown a moment was.

        Moments are shown in the frame that is nearest to them and counted from there on: else a
        pulse would be caught now at its peak and now half a frame after it.

        Args:
            since: Half a frame late [s], [N], so that a frame just before a moment has it.
        """
        rate = float(self.clock.rate)
        moments = np.where(np.isfinite(since), self._late - since, 0.0)
        shown = np.floor(moments * rate + 0.5 + 1e-6) / rate
        ago = np.where(since - self.half < self.half, 0.0, np.maximum(self.times - shown, 0.0))
        return np.where(np.isfinite(since), ago, NEVER)

    @cached_property
    def _heard(self) -> Heard:
        if self.clock.heard is None:
            raise OptionError(
                "there is no sound; give --audio SONG, or --beats FILE with strengths"
            )
        return self.clock.heard
