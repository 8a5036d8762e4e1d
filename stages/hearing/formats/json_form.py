"""Our own file of what was heard, JSON; also a bare list of times."""

import json
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np

from stages.hearing.contour import Contour
from stages.hearing.heard import MOST_BEATS, USUAL_METER, Heard, Mark, usual_bpm

DIGITS = 4
"""Decimals of times [s] and of strengths: a tenth of a millisecond, a ten-thousandth."""
MOST_METER = 32
"""Beats of a bar at most; beyond it a number is a mistake."""
MOST_TIME = 1e9
"""Seconds, and beats a minute, at most; beyond it a number is a mistake too."""
MOST_RATE = 1e6
"""Values a second at most [Hz]."""
LEAST = 1e-6
"""Beats a minute, values a second, and seconds from one time to the next, at least."""


def as_json(heard: Heard) -> str:
    """What was heard as text of one line an entry, which `from_json` reads.

    Args:
        heard: What was heard.
    """
    parts: dict[str, object] = {
        "duration": round(heard.duration, DIGITS),
        "bpm": None if heard.bpm is None else round(heard.bpm, 2),
        "meter": heard.meter,
        "beats": _rounded(heard.beats),
        "downbeats": _rounded(heard.downbeats),
        "onsets": _rounded(heard.onsets),
    }
    if heard.sections:
        marks = [{"time": round(one.time, DIGITS), "name": one.name} for one in heard.sections]
        parts["sections"] = marks
    lines = [f"  {json.dumps(name)}: {json.dumps(value)}" for name, value in parts.items()]
    strengths = [
        f"    {json.dumps(name)}: " + json.dumps({"rate": one.rate, "values": _rounded(one.values)})
        for name, one in heard.envelopes.items()
    ]
    inside = "\n" + ",\n".join(strengths) + "\n  " if strengths else ""
    lines.append('  "envelopes": {' + inside + "}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def from_json(text: str) -> Heard:
    """Read what was heard.

    Args:
        text: An object as `as_json` makes it, of which `beats` alone must be there, or a list of
            times of beats [s].

    Raises:
        ValueError: If it is something else; the message says what.
    """
    try:
        found = json.loads(text)
    except RecursionError as error:
        raise ValueError("brackets are nested too deeply") from error
    if isinstance(found, list):
        found = {"beats": found}
    if not isinstance(found, dict):
        raise ValueError("is neither an object nor a list of times")
    if "beats" not in found and "sections" not in found:
        raise ValueError("has neither beats nor sections")
    times = {name: _times(found, name) for name in ("beats", "downbeats", "onsets")}
    ends = [float(one[-1]) for one in times.values() if len(one)]
    duration = _number(found.get("duration", max(ends, default=0.0)), "duration")
    envelopes = {str(n): _envelope(e, n) for n, e in _mapping(found, "envelopes").items()}
    meter = found.get("meter", USUAL_METER)
    if not isinstance(meter, int) or not 1 <= meter <= MOST_METER:
        raise ValueError(f"meter {meter!r} must be a whole number from 1 to {MOST_METER}")
    bpm = found.get("bpm")
    if bpm is not None and _number(bpm, "bpm") < LEAST:
        raise ValueError(f"bpm {bpm!r} must be above 0")
    marks = found.get("sections", [])
    if not isinstance(marks, list):
        raise ValueError("sections is not a list")
    return Heard(
        duration,
        usual_bpm(times["beats"]) if bpm is None else float(bpm),
        **times,
        envelopes=envelopes,
        sections=tuple(_mark(one) for one in marks),
        meter=meter,
    )


def _rounded(values: np.ndarray) -> list[float]:
    return [round(float(value), DIGITS) for value in values]


def _number(value: object, name: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or value != value:  # NaN
        raise ValueError(f"{name} holds {value!r}, which is not a number")
    if abs(value) > MOST_TIME:
        raise ValueError(f"{name} holds {str(value)[:20]}, which is too large")
    return float(value)


def _times(found: Mapping[str, Any], name: str) -> np.ndarray:
    values = found.get(name, [])
    if not isinstance(values, list):
        raise ValueError(f"{name} is not a list")
    if len(values) > MOST_BEATS:
        raise ValueError(f"{name} holds more than {MOST_BEATS} times")
    times = [_number(value, name) for value in values]
    for before, after in pairwise(times):
        if after - before < LEAST:
            raise ValueError(f"{name} go back from {before:g} to {after:g} s")
    return np.array(times, dtype=float)


def _mapping(found: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    value = found.get(name, {})
    if not isinstance(value, dict):
        raise ValueError(f"{name} is not an object")
    return value


def _envelope(found: object, name: str) -> Contour:
    if not isinstance(found, dict) or not isinstance(found.get("values"), list):
        raise ValueError(f"envelope {name} has no list of values")
    rate = _number(found.get("rate"), f"rate of envelope {name}")
    if not LEAST <= rate <= MOST_RATE:
        raise ValueError(
            f"rate of envelope {name} is {rate:g}, not above 0 and up to {MOST_RATE:g}"
        )
    values = [_number(value, f"envelope {name}") for value in found["values"]]
    for value in values:
        if not 0 <= value <= 1:
            raise ValueError(f"envelope {name} holds {value:g}; strengths go from 0 to 1")
    return Contour(rate, np.array(values, dtype=np.float32))


def _mark(found: object) -> Mark:
    if not isinstance(found, dict):
        raise ValueError(f"a section is {found!r}, not an object with time and name")
    return Mark(_number(found.get("time"), "time of a section"), str(found.get("name", "")))
