"""The functions of expressions."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from pipeline.timeline.signals import EVENTS, STRENGTHS, Signals
from pipeline.timeline.times import Span, Unit

Value = Any
"""A number, or one for every frame [N]."""
LEFT = math.log(20.0)
"""After its decay a twentieth of a pulse is left."""

MOST_WHOLE = float(1 << 53)
"""Beyond it numbers have no whole parts that differ by one."""


class FaultError(Exception):
    """A part of an expression is no number at some frame.

    Args:
        problem: What is wrong.
        where: In which frames, broadcast to [N] bool.
        column: How far into the expression; 0 if unknown.
        remedy: What to do.
    """

    def __init__(self, problem: str, where: np.ndarray, column: int, remedy: str) -> None:
        super().__init__(problem)
        self.problem = problem
        self.where = where
        self.column = column
        self.remedy = remedy


@dataclass(frozen=True)
class Length:
    """A length of time in an expression."""

    span: Span
    """How long."""


@dataclass(frozen=True, eq=False)
class Given:
    """An argument."""

    length: Length | None
    """The length of time that it is, or that moments are apart."""
    code: Callable[[Signals], Value] | None
    """What it comes to."""
    name: str | None = None
    """The variable that it is, or `every`."""
    fixed: float | None = None
    """The number that it is."""
    is_whole: bool = False
    """Whether it is a variable or `every(...)` and nothing else."""

    def value(self, signals: Signals) -> Value:
        """The number at every frame; of a length the seconds."""
        return signals.seconds(self._span) if self.code is None else self.code(signals)

    @property
    def _span(self) -> Span:
        assert self.length is not None
        return self.length.span

    @property
    def span(self) -> Span:
        """The length; a bare number counts seconds.

        Raises:
            ValueError: If it is neither.
        """
        if self.length is not None and self.code is None:
            return self.length.span
        if self.fixed is None or self.fixed < 0:
            raise ValueError("takes a length of time there")
        return Span(Fraction(self.fixed), Unit.SECONDS)

    def since(self, signals: Signals) -> np.ndarray:
        """How long ago the last of the moments that it stands for was [s]."""
        if self.name == "every":
            return signals.since_every(self._span)
        assert self.name is not None
        return signals.since(self.name)


Bound = Callable[[Sequence[Given], Mapping[str, Given]], Callable[[Signals], Value]]


@dataclass(frozen=True)
class Function:
    """A function of expressions."""

    form: str
    """How it is written, for messages."""
    bind: Bound
    """Makes of its arguments what it comes to; raises ValueError if they do not fit."""


def division(one: Value, other: Value, apply: Callable[[Value, Value], Value]) -> Value:
    """A quotient or a rest; dividing by zero is a fault.

    Args:
        one: What is divided.
        other: By what.
        apply: The operation.
    """
    zero = np.equal(other, 0.0)
    if np.any(zero):
        raise FaultError("divides by zero", zero, 0, "add something to what it divides by")
    return apply(np.asarray(one, float), other)


def _numbers(
    least: int, most: int, apply: Callable[..., Value], names: Sequence[str] = ()
) -> Bound:
    """A function of numbers."""

    def bind(given: Sequence[Given], named: Mapping[str, Given]) -> Callable[[Signals], Value]:
        """See `Function.bind`."""
        if named or not least <= len(given) <= most:
            counted = f"{least}" if least == most else f"{least} to {most}"
            raise ValueError(f"takes {counted} numbers and no names")
        return lambda signals: apply(*(one.value(signals) for one in given))

    return bind


def _each(function: Callable[[float], float]) -> Callable[[Value], Value]:
    """A function of one number, for each on its own: the last bit does not depend on the others.

    Of what is infinite it is no number, which is told later, with its frame.
    """

    def one_of(value: float) -> float:
        """For one number."""
        return function(value) if math.isfinite(value) else math.nan

    def apply(value: Value) -> Value:
        """For each on its own."""
        if np.ndim(value) == 0:
            return one_of(float(value))
        return np.array([one_of(float(one)) for one in value])

    return apply


def _smallest(*values: Value) -> Value:
    return _folded(np.minimum, values)


def _largest(*values: Value) -> Value:
    return _folded(np.maximum, values)


def _folded(apply: Callable[[Value, Value], Value], values: Sequence[Value]) -> Value:
    found = values[0]
    for value in values[1:]:
        found = apply(found, value)
    return found


def _lerp(one: Value, other: Value, share: Value) -> Value:
    return one + (other - one) * share


def _rise(share: Value) -> Value:
    """3 x^2 - 2 x^3 from 0 to 1, level at both ends."""
    x = np.clip(share, 0.0, 1.0)
    return x * x * (3.0 - 2.0 * x)


def chance(number: Value, seed: int = 0) -> np.ndarray:
    """Numbers from 0 to below 1 without order, the same for all numbers of one whole part.

    Args:
        number: The numbers.
        seed: Chooses others.
    """
    bounded = np.clip(np.asarray(number, float), -MOST_WHOLE, MOST_WHOLE)
    whole = np.floor(bounded).astype(np.int64).astype(np.uint64)
    with np.errstate(over="ignore"):
        mixed = whole * np.uint64(0x9E3779B97F4A7C15) + np.uint64(seed & 0xFFFFFFFF)
        for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
            mixed = (mixed ^ (mixed >> np.uint64(shift))) * np.uint64(factor)
        mixed = mixed ^ (mixed >> np.uint64(31))
    return (mixed >> np.uint64(11)).astype(float) / float(1 << 53)


def _random(given: Sequence[Given], named: Mapping[str, Given]) -> Callable[[Signals], Value]:
    if len(given) != 1 or named:
        raise ValueError("takes one number")
    return lambda signals: chance(given[0].value(signals), 1)


def _noise(given: Sequence[Given], named: Mapping[str, Given]) -> Callable[[Signals], Value]:
    """Numbers from -1 to 1 that wander."""
    period = named.get("period", given[1] if len(given) == 2 else None)
    if not 1 <= len(given) <= 2 or given[0].fixed is None or set(named) - {"period"}:
        raise ValueError("takes a whole number, and how long it takes to wander")
    seed = int(given[0].fixed)
    span = Span(Fraction(1), Unit.SECONDS) if period is None else period.span
    if span.amount <= 0:
        raise ValueError("takes a length above 0")

    def wander(signals: Signals) -> Value:
        """From one number without order to the next."""
        if span.unit is Unit.BEATS:
            place = signals.value("b") / float(span.amount)
        elif span.unit is Unit.BARS:
            place = signals.value("bar") / float(span.amount)
        else:
            place = signals.times / signals.clock.later(0.0, span)
        whole = np.floor(place)
        ends = [2.0 * chance(whole + step, seed + 2) - 1.0 for step in (0, 1)]
        return ends[0] + (ends[1] - ends[0]) * _rise(place - whole)

    return wander


def _env(given: Sequence[Given], named: Mapping[str, Given]) -> Callable[[Signals], Value]:
    """A pulse that begins at each moment."""
    if len(given) != 1 or set(named) - {"decay", "attack"}:
        raise ValueError("takes moments, decay= and attack=")
    moments = given[0]
    if moments.name not in (*EVENTS, "shot", "every") or not moments.is_whole:
        known = ", ".join(EVENTS)
        raise ValueError(f"takes moments first: {known}, shot or every(2 beats)")
    for name, one in named.items():
        if one.span.amount <= 0 and name == "decay":
            raise ValueError("takes a decay above 0")

    def pulse(signals: Signals) -> Value:
        """Up in the attack, down in the decay."""
        since = moments.since(signals)
        decay, attack = (
            signals.seconds(named[name].span) if name in named else usual
            for name, usual in (("decay", 0.25), ("attack", 0.0))
        )
        rise = np.minimum(1.0, since / np.maximum(attack, 1e-9)) if np.any(attack) else 1.0
        fall = (since - attack) / decay
        falls = np.broadcast_to(fall, since.shape)
        left = np.array([math.exp(-LEFT * max(0.0, float(one))) for one in falls])
        return np.where(np.isfinite(since), rise * left, 0.0)

    return pulse


def _every(given: Sequence[Given], named: Mapping[str, Given]) -> Callable[[Signals], Value]:
    """1 in the frames of evenly spaced moments."""
    if len(given) != 1 or named or given[0].length is None:
        raise ValueError("takes a length of time")
    span = given[0].length.span
    if span.amount <= 0:
        raise ValueError("takes a length above 0")
    return lambda signals: signals.strikes(signals.since_every(span))


def _smooth(given: Sequence[Given], named: Mapping[str, Given]) -> Callable[[Signals], Value]:
    """A rise from 0 to 1, or a strength of the sound without its trembling."""
    if len(given) == 1 and not named:
        return lambda signals: _rise(given[0].value(signals))
    if len(given) != 2 or named or given[0].name not in STRENGTHS or not given[0].is_whole:
        raise ValueError(f"takes one number, or {', '.join(STRENGTHS)} and a length of time")
    name, span = given[0].name, given[1].span
    assert name is not None
    if span.unit.needs_beats:
        raise ValueError("takes seconds there")
    return lambda signals: signals.strength(name, signals.clock.later(0.0, span))


FUNCTIONS: dict[str, Function] = {
    "sin": Function("sin(x)", _numbers(1, 1, _each(math.sin))),
    "cos": Function("cos(x)", _numbers(1, 1, _each(math.cos))),
    "abs": Function("abs(x)", _numbers(1, 1, np.abs)),
    "floor": Function("floor(x)", _numbers(1, 1, np.floor)),
    "min": Function("min(a, b)", _numbers(2, 8, _smallest)),
    "max": Function("max(a, b)", _numbers(2, 8, _largest)),
    "clamp": Function(
        "clamp(x, least, most)", _numbers(3, 3, lambda x, a, b: np.minimum(np.maximum(x, a), b))
    ),
    "lerp": Function("lerp(a, b, share)", _numbers(3, 3, _lerp)),
    "smooth": Function("smooth(x) or smooth(rms, 0.3s)", _smooth),
    "noise": Function("noise(1) or noise(1, 2s)", _noise),
    "env": Function("env(beat, decay=0.25s)", _env),
    "every": Function("every(2 beats)", _every),
    "random": Function("random(floor(b))", _random),
}
"""By name."""
