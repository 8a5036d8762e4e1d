"""Keyframes: `0s: 1, bar 9: 3 ease-in-out, +2 bars: 1`.

An easing rules the segment that leaves its key. A key is at the frame that is nearest to its time,
so a step is on the frame and a peak is reached.
"""

from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from pipeline.options.nearest import nearest
from pipeline.timeline.clock import Clock
from pipeline.timeline.easings import EASINGS, STEPS, easing_name
from pipeline.timeline.mixing import mixed
from pipeline.timeline.targets import is_color
from pipeline.timeline.times import When, parse_when
from pipeline.timeline.written.place import Place
from warp_kernels.errors import OptionError

Reader = Callable[[str], Any]
"""Reads a value; raises ValueError or OptionError with a message that ends with a remedy."""


@dataclass(frozen=True)
class Key:
    """A value at a moment."""

    when: When
    """The moment."""
    value: Any
    """A number, or a text."""
    ease: str
    """How the value goes on to the next one, a key of `EASINGS`."""
    place: Place
    """Where it stands in the file."""


def is_keyframes(text: str) -> bool:
    """Whether a text is meant to be keyframes, not an expression."""
    return ":" in text


def parse_keys(text: str, place: Place, read: Reader) -> tuple[Key, ...]:
    """Read keyframes.

    Args:
        text: What the user wrote.
        place: Where it begins.
        read: Reads a value.

    Raises:
        OptionError: If a key has another form, or the reader refuses its value.
    """
    keys = []
    begin = 0
    for part in text.split(","):
        here = place.after(begin + len(part) - len(part.lstrip()))
        begin += len(part) + 1
        if not part.strip():
            raise here.error(f"an empty key in {text!r}; write TIME: VALUE, TIME: VALUE")
        keys.append(_key(part.strip(), here, read))
    return tuple(keys)


def _key(text: str, place: Place, read: Reader) -> Key:
    when, colon, rest = text.rpartition(":")
    if not colon:
        raise place.error(f"{text!r} is no key; write TIME: VALUE, such as 2s: {text.split()[0]}")
    words = rest.split()
    if not words:
        raise place.error(f"{text!r} has no value; write {when.strip()}: VALUE")
    ease = "linear"
    if len(words) > 1:
        found = easing_name(words[-1])
        if found is None:
            raise place.error(f"no easing {words[-1]!r}; {nearest(words[-1], EASINGS)}")
        ease, words = found, words[:-1]
    value = " ".join(words)
    if value.startswith("(") and value.endswith(")"):  # as Deforum writes values
        value = value[1:-1].strip()
    try:
        return Key(parse_when(when), read(value), ease, place)
    except (ValueError, OptionError) as error:
        raise place.error(error) from error


@dataclass(frozen=True, eq=False)
class Keyed:
    """Keys at their times."""

    times: tuple[float, ...]
    """When they are, ascending [s]."""
    values: tuple[Any, ...]
    """What the value is then."""
    eases: tuple[str, ...]
    """How it goes on."""

    @classmethod
    def of(cls, keys: Sequence[Key], clock: Clock, start: float = 0.0) -> "Keyed":
        """Find out when keys are.

        Args:
            keys: The keys.
            clock: The time of the film.
            start: What the first key counts from if it is relative [s].

        Raises:
            OptionError: If two fall on one frame, or one comes before the one before it or after
                the end of the film.
        """
        frames: list[int] = []
        exact = start
        for key in keys:
            try:
                exact = clock.time_of(key.when, exact)
            except OptionError as error:
                raise key.place.error(error) from error
            frame = clock.frame_at(exact)
            if frames and frame <= frames[-1]:
                raise key.place.error(_disorder(frame, frames[-1], clock.first))
            if clock.count is not None and frame > clock.first + clock.count:
                raise key.place.error(
                    f"{clock.name_of(exact)} is after the end of the film at "
                    f"{clock.name_of(clock.end or 0.0)}; leave the key out or write end"
                )
            frames.append(frame)
        times = tuple(clock.time_of_frame(frame) for frame in frames)
        return cls(times, tuple(key.value for key in keys), tuple(key.ease for key in keys))

    def at(self, time: float) -> Any:
        """The value at a time [s]; that of the first key before it, of the last one after it."""
        place = bisect_right(self.times, time) - 1
        if place < 0 or place + 1 == len(self.times):
            return self.values[max(place, 0)]
        one, other, ease = self.values[place], self.values[place + 1], self.eases[place]
        begin, end = self.times[place], self.times[place + 1]
        share = EASINGS[ease]((time - begin) / (end - begin))
        if isinstance(one, str | bool):
            if ease not in STEPS and isinstance(one, str) and runs_between(one, other):
                return mixed(one, other, share)
            return (one, other)[share >= 1]
        return one + share * (other - one)


def runs_between(one: str, other: str) -> bool:
    """Whether there is something between two texts: they are colours."""
    return is_color(one) and is_color(other)


def _disorder(frame: int, before: int, first: int) -> str:
    if frame < first:
        return f"the key is at frame {frame}, before the film begins; leave it out or move it"
    if frame == before:
        return f"two keys fall on frame {frame}; leave one out or move it by a frame"
    return f"the key at frame {frame} comes after that at frame {before}; put them in order"
