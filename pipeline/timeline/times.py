"""Times as people write them: `12.5s`, `1:02.5`, `f240`, `b32`, `bar 9.3`, `50%`, `+4 bars`, ..."""

import re
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction

_NUMBER = r"(\d+(?:\.\d*)?|\.\d+)"
_CLOCK = re.compile(r"(?:(\d+):)?(\d+):(\d+(?:\.\d*)?)")
_SPAN = re.compile(rf"{_NUMBER} *(ms|s|sec|seconds?|frames?|f|beats?|bars?)")
_FRAME = re.compile(r"f(?:rame)? *(\d+)")
_BEAT = re.compile(rf"b(?:eat)? *{_NUMBER}")
_BAR = re.compile(r"bar *(\d+)(?:\.(\d+(?:\.\d+)?))?")
_SHARE = re.compile(rf"(bar at )? *{_NUMBER} *%")

FORM = (
    "write 12.5s, 1:02.5, f240, b32, bar 9, bar 9.3, 50%, bar at 50%, start, end, at chorus, "
    "or +4 bars"
)
"""How times are written, for messages."""
SPAN_FORM = "write 2s, 250ms, 12 frames, 1 beat or 4 bars"
"""How spans of time are written, for messages."""


MOST = 10**9
"""Seconds, frames, beats and bars beyond all films: more are a mistake."""


class Unit(Enum):
    """What a time is counted in."""

    SECONDS = "s"
    FRAMES = "frames"
    BEATS = "beats"
    BARS = "bars"

    @property
    def needs_beats(self) -> bool:
        """Whether something must be heard to know what time it is."""
        return self in (Unit.BEATS, Unit.BARS)


@dataclass(frozen=True)
class Span:
    """A length of time."""

    amount: Fraction
    """How long, 0 or more."""
    unit: Unit
    """In what."""

    def __str__(self) -> str:
        unit = self.unit.value.removesuffix("s") if self.amount == 1 else self.unit.value
        return f"{float(self.amount):g} {unit or self.unit.value}"


@dataclass(frozen=True)
class When:
    """A moment: so long after the beginning of the film, or after another moment."""

    span: Span
    """How long; bars and beats of a bar count from 0 here."""
    beat: Fraction = Fraction(0)
    """Beats into the bar."""
    is_relative: bool = False
    """Whether it counts from the moment before it in the file."""
    share: Fraction | None = None
    """The part of the film after which it is, in place of a length of time."""
    is_on_bar: bool = False
    """Whether it is a bar or a beat near to that, if there is one."""
    name: str = ""
    """Small letters of the section of the song with which it comes, in place of all that."""

    @property
    def needs_beats(self) -> bool:
        """Whether something must be heard to know when it is."""
        return self.span.unit.needs_beats or self.is_on_bar or bool(self.name)


START = When(Span(Fraction(0), Unit.SECONDS))
"""The beginning of the film."""


def parse_when(text: str) -> When:
    """Read a moment.

    Args:
        text: What the user wrote.

    Raises:
        ValueError: If it is none; the message says what is.
    """
    plain = " ".join(text.lower().split())
    if plain.startswith("+"):
        return When(parse_span(plain[1:].strip()), is_relative=True)
    if plain in ("start", "0"):
        return START
    if plain.startswith("at "):
        return When(START.span, name=plain[3:])
    if plain == "end":
        return When(START.span, share=Fraction(1))
    found = _clock(plain) or _bar(plain) or _share(plain)
    if found is not None:
        return found
    for form, unit in ((_FRAME, Unit.FRAMES), (_BEAT, Unit.BEATS)):
        match = form.fullmatch(plain)
        if match is not None:
            return When(Span(_amount(match[1]), unit))
    match = _SPAN.fullmatch(plain)
    if match is not None:
        span = parse_span(plain)
        if span.unit is Unit.SECONDS:
            return When(span)
        raise ValueError(f"{text!r}: {_instead(span)}")
    if re.fullmatch(_NUMBER, plain):
        forms = f"{plain}s, f{plain.split('.')[0]} or b{plain}"
        raise ValueError(f"{text!r} has no unit; write {forms}")
    raise ValueError(f"{text!r} is no time; {FORM}")


def parse_span(text: str) -> Span:
    """Read a length of time, such as `2s`, `12 frames` or `4 bars`.

    Args:
        text: What the user wrote.

    Raises:
        ValueError: If it is none; the message says what is.
    """
    plain = " ".join(text.lower().split())
    clock = _clock(plain)
    if clock is not None:
        return clock.span
    match = _SPAN.fullmatch(plain)
    if match is None:
        raise ValueError(f"{text!r} is no length of time; {SPAN_FORM}")
    amount, unit = _amount(match[1]), match[2]
    if unit == "ms":
        return Span(amount / 1000, Unit.SECONDS)
    units = {"s": Unit.SECONDS, "f": Unit.FRAMES, "be": Unit.BEATS, "ba": Unit.BARS}
    return Span(amount, units.get(unit[:2]) or units[unit[0]])


def _clock(plain: str) -> When | None:
    match = _CLOCK.fullmatch(plain)
    if match is None:
        return None
    minutes, seconds = _amount(match[2]), _amount(match[3])
    if seconds >= 60 or (match[1] and minutes >= 60):
        raise ValueError(f"{plain!r}: minutes and seconds of a clock go up to 59; write 1:30")
    total = _amount(match[1] or "0") * 3600 + minutes * 60 + seconds
    return When(Span(total, Unit.SECONDS))


def _amount(digits: str) -> Fraction:
    """The number that digits are.

    Raises:
        ValueError: If no film is that long.
    """
    if len(digits.partition(".")[0].lstrip("0")) > len(str(MOST)) or Fraction(digits) > MOST:
        short = digits if len(digits) <= 20 else f"{digits[:17]}..."
        raise ValueError(f"{short}: no film is that long; write a shorter time")
    return Fraction(digits)


def _bar(plain: str) -> When | None:
    match = _BAR.fullmatch(plain)
    if match is None:
        return None
    bar, beat = _amount(match[1]), _amount(match[2] or "1")
    if bar < 1 or beat < 1:
        raise ValueError(f"{plain!r}: bars and the beats of a bar count from 1; write bar 1")
    return When(Span(bar - 1, Unit.BARS), beat - 1)


def _share(plain: str) -> When | None:
    match = _SHARE.fullmatch(plain)
    if match is None:
        return None
    share = _amount(match[2]) / 100
    if share > 1:
        raise ValueError(f"{plain!r}: the film ends at 100%; write end")
    return When(START.span, share=share, is_on_bar=bool(match[1]))


def _instead(span: Span) -> str:
    """What to write for a length where a moment is wanted."""
    amount = f"{float(span.amount):g}"
    own = {
        Unit.FRAMES: f"f{amount}",
        Unit.BEATS: f"b{amount}",
        Unit.BARS: f"bar {int(span.amount) + 1}",
    }
    return f"is a length, not a moment; write {own[span.unit]}, or +{amount} {span.unit.value}"
