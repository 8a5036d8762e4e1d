"""What is heard in a sound, and where its beats and bars are.

Beats are counted from 0, the first one that is heard; bars from 1, whose first beat is the first
downbeat, and the beats of a bar from 1. Between two beats time runs evenly. Before the first and
after the last one the tempo of those next to it goes on.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from stages.hearing.contour import Contour
from stages.hearing.scale import Scale, evenly_on
from warp_kernels.errors import OptionError

MOST_BEATS = 100_000
"""Beats of a file at most: days of music."""
USUAL_METER = 4
"""Beats of a bar where nothing says how many there are."""
_NEAR = 8
"""Beats whose mean tempo goes on beyond the first and the last one."""


@dataclass(frozen=True)
class Mark:
    """A named moment, at which a section begins."""

    time: float
    """[s]"""
    name: str
    """What a person called it."""


@dataclass(frozen=True, eq=False)
class Heard:
    """Beats, bars, onsets and envelopes of a sound; times are seconds from its start.

    All times are ascending. Of a film's own sound they count from its first picture.

    Raises:
        ValueError: If times are not ascending or not numbers.
    """

    duration: float
    """How long the sound is [s]."""
    bpm: float | None = None
    """The usual number of beats a minute; None if there is no beat."""
    beats: np.ndarray = field(default_factory=lambda: np.empty(0))
    """Times of beats [s], [B] float64."""
    downbeats: np.ndarray = field(default_factory=lambda: np.empty(0))
    """Times of the first beats of bars [s], [D] float64."""
    onsets: np.ndarray = field(default_factory=lambda: np.empty(0))
    """Times at which something begins to sound [s], [O] float64."""
    envelopes: Mapping[str, Contour] = field(default_factory=dict)
    """Strengths over time, by name: `loudness`, `low`, `mid`, `high`, `centroid`."""
    sections: tuple[Mark, ...] = ()
    """Where sections begin, if a file says so."""
    meter: int = USUAL_METER
    """Beats of a bar, where no downbeats say how many there are."""

    def __post_init__(self) -> None:
        for name in ("beats", "downbeats", "onsets"):
            times = np.asarray(getattr(self, name), dtype=float)
            if not np.isfinite(times).all() or (np.diff(times) <= 0).any():
                raise ValueError(f"{name} must be ascending numbers")
            object.__setattr__(self, name, times)

    @classmethod
    def steady(
        cls, duration: float, bpm: float, meter: int = USUAL_METER, first: float = 0.0
    ) -> "Heard":
        """Beats of a tempo that never changes, where there is no sound to hear them in.

        Args:
            duration: [s]
            bpm: Beats a minute.
            meter: Beats of a bar.
            first: Time of the first downbeat [s].
        """
        count = max(int(np.ceil((duration - first) * bpm / 60)), 2)
        beats = first + np.arange(count) * 60 / bpm
        return cls(duration, bpm, beats, beats[::meter], meter=meter)

    @property
    def has_beats(self) -> bool:
        """Whether beats and bars can be asked for."""
        return len(self.beats) > 1 or self.bpm is not None

    def with_downbeats(self, meter: int | None = None) -> "Heard":
        """The same with the first beats of bars, where fewer than two of them are known.

        Args:
            meter: Beats of a bar; None for those that are known.
        """
        if len(self.downbeats) > 1 or not len(self.beats):
            return self
        meter, first = meter or self.meter, 0
        if len(self.downbeats):
            first = int(np.abs(self.beats - self.downbeats[0]).argmin())
        return replace(self, downbeats=self.beats[first::meter], meter=meter)

    def told_by(self, other: "Heard") -> "Heard":
        """The same sound with what another source says of it: a person, or another program.

        Args:
            other: Its beats and bars count, its onsets, its sections and its envelopes, each where
                it has any.
        """
        timed = other if other.has_beats else self
        return replace(
            timed,
            duration=max(self.duration, other.duration),
            sections=other.sections or self.sections,
            onsets=other.onsets if len(other.onsets) else self.onsets,
            envelopes={**self.envelopes, **other.envelopes},
        )

    def moved(self, by: float) -> "Heard":
        """The same sound, started later.

        Args:
            by: How much later [s]; less than 0 for earlier, which drops the beginning of envelopes.
        """
        return replace(
            self,
            duration=max(self.duration + by, 0.0),
            beats=self.beats + by,
            downbeats=self.downbeats + by,
            onsets=self.onsets + by,
            envelopes={name: _moved(one, by) for name, one in self.envelopes.items()},
            sections=tuple(replace(mark, time=mark.time + by) for mark in self.sections),
        )

    def envelope(self, name: str) -> Contour:
        """A strength over time.

        Args:
            name: One of `envelopes`.

        Raises:
            OptionError: If it was not heard, as in files that hold beats only.
        """
        found = self.envelopes.get(name)
        if found is None:
            known = ", ".join(self.envelopes) or "none: the file holds beats only"
            raise OptionError(
                f"{name}: nothing tells how strong it is ({known}); "
                "give --audio SONG, or what trimotion listen writes"
            )
        return found

    def beat_at(self, time: float | np.ndarray) -> float | np.ndarray:
        """How many beats after the first one a time is.

        Args:
            time: [s], a number or an array.

        Raises:
            OptionError: If there is no beat.
        """
        return self._beats.place_of(time)

    def time_of_beat(self, beat: float | np.ndarray) -> float | np.ndarray:
        """The time of a beat, or of a place between two [s].

        Args:
            beat: Counted from 0, a number or an array.

        Raises:
            OptionError: If there is no beat.
        """
        return self._beats.mark_of(beat)

    def bar_at(self, time: float | np.ndarray) -> float | np.ndarray:
        """The bar at a time, from 1; the fraction says how much of it is over.

        Args:
            time: [s], a number or an array.

        Raises:
            OptionError: If there is no beat.
        """
        return self._bars.place_of(self.beat_at(time))

    def time_of_bar(self, bar: float, beat: float = 1.0) -> float:
        """The time of a bar, or of a beat of it [s].

        Args:
            bar: Counted from 1.
            beat: Counted from 1 in the bar; `2.5` lies between its second and third one.

        Raises:
            OptionError: If there is no beat.
        """
        start = float(self._bars.mark_of(bar))
        return float(self.time_of_beat(start + beat - 1))

    def since(self, times: str, time: float | np.ndarray) -> float | np.ndarray:
        """How long ago the last beat, downbeat or onset was [s]; infinite before the first.

        Args:
            times: `beats`, `downbeats` or `onsets`.
            time: [s], a number or an array.
        """
        known = np.concatenate([[-np.inf], getattr(self, times)])
        last = known[np.searchsorted(known, time, side="right") - 1]
        return np.asarray(time) - last if np.ndim(time) else float(time - last)

    @cached_property
    def _beats(self) -> Scale:
        """Beats by time."""
        if len(self.beats) > 1:
            return Scale(self.beats, 0.0, _NEAR)
        if self.bpm is None:
            raise OptionError("the sound has no beat; give --bpm, or --beats FILE")
        first = float(self.beats[0]) if len(self.beats) else 0.0
        return evenly_on(first, 60 / self.bpm)

    @cached_property
    def _bars(self) -> Scale:
        """Bars by beats."""
        if len(self.downbeats) > 1:
            return Scale(np.asarray(self.beat_at(self.downbeats)), 1.0, _NEAR)
        first = float(self.beat_at(float(self.downbeats[0]))) if len(self.downbeats) else 0.0
        return evenly_on(first, float(self.meter), 1.0)


def usual_bpm(beats: np.ndarray) -> float | None:
    """The middle one of the tempos between beats, in beats a minute; None for fewer than two.

    Args:
        beats: Times [s], ascending.
    """
    return float(60 / np.median(np.diff(beats))) if len(beats) > 1 else None


def _moved(envelope: Contour, by: float) -> Contour:
    """An envelope whose sound starts later, or earlier."""
    count = max(len(envelope.values) + round(by * envelope.rate), 0)
    times = np.arange(count) / envelope.rate - by
    return Contour(envelope.rate, np.asarray(envelope.at(times), dtype=np.float32))
