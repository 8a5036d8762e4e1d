"""Beats as text, one a line: bare times, times with the beat of the bar, CSV, Audacity's labels.

A line is a time [s, or m:ss], then what there may be: a second time at which it ends, and a word.
A word that is a number is the place in the bar (`1` is a downbeat; ours are `bar.beat`); `beat`,
`downbeat`, `onset` and their usual short forms say what begins there; any other word names a
section, unless all lines have the same one.
"""

import re
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from stages.hearing.heard import MOST_BEATS, USUAL_METER, Heard, Mark, usual_bpm

_BEATS = frozenset({"", "b", "beat", "x", "tick", "click"})
_DOWNBEATS = frozenset({"db", "downbeat", "down", "bar", "measure", "|"})
_ONSETS = frozenset({"o", "onset"})
_IN_BAR = re.compile(r"(?:\d+\.)?(\d{1,2})|beat\s*(\d{1,2})", re.IGNORECASE)
_MOST_IN_BAR = 16
"""Larger numbers count the beats of the whole piece."""
_MOST_TIME = 1e9
"""Seconds; larger numbers are no times."""
_COMMA = re.compile(r"(\d{1,9}),(\d{1,9})")
_CLOCK = re.compile(r"(?:(\d+):)?(\d+):(\d+(?:\.\d*)?)")


@dataclass(frozen=True)
class Entry:
    """A line of such a file."""

    number: int
    """Its place in the file, from 1."""
    time: float
    """When it is [s]."""
    word: str
    """What stands behind the times; empty for nothing."""


def from_lines(text: str) -> Heard:
    """Read beats and sections, in any of the forms above.

    Args:
        text: The file.

    Raises:
        ValueError: If a line is something else; the message begins with its number.
    """
    lines = _read(text)
    if not lines:
        raise ValueError("holds no time")
    if not any(line.word for line in lines):  # bare times; labels may be written kind by kind
        for before, after in pairwise(lines):
            if after.time < before.time:
                back = f"goes back from {before.time:g} to {after.time:g} s"
                raise ValueError(f"line {after.number}: {back}")
    lines.sort(key=lambda line: line.time)
    words = {line.word.lower() for line in lines}
    if len(words) == 1 and not _IN_BAR.fullmatch(min(words)):
        words = {""}
        lines = [Entry(line.number, line.time, "") for line in lines]
    places = [_place(line.word) for line in lines]
    counted = max((place for place in places if place is not None), default=0) > _MOST_IN_BAR
    kinds = [line.word.lower() for line in lines]
    beats, downbeats, onsets, marks = [], [], [], []
    for line, word, place in zip(lines, kinds, places, strict=True):
        if word in _ONSETS:
            onsets.append(line.time)
        elif place is not None or word in _BEATS | _DOWNBEATS:
            beats.append(line.time)
            if word in _DOWNBEATS or (place == 1 and not counted):
                downbeats.append(line.time)
        else:
            marks.append(Mark(line.time, line.word))
    kept = np.unique(beats)
    meter = 0 if counted else max((place or 0 for place in places), default=0)
    return Heard(
        lines[-1].time,
        usual_bpm(kept),
        kept,
        np.unique(downbeats),
        np.unique(onsets),
        sections=tuple(marks),
        meter=meter or USUAL_METER,
    )


def as_labels(heard: Heard) -> str:
    """Beats and sections as labels of Audacity: start, end and `bar.beat`, with tabs between.

    Args:
        heard: What was heard.
    """
    rows = [(mark.time, mark.name or "section") for mark in heard.sections]
    places = np.searchsorted(heard.downbeats, heard.beats + 1e-6)
    firsts = np.searchsorted(heard.beats, heard.downbeats - 1e-6)
    for number, time in enumerate(heard.beats):
        bar = int(places[number])
        if bar:
            rows.append((float(time), f"{bar}.{number - int(firsts[bar - 1]) + 1}"))
        else:  # before the first downbeat: an upbeat, which counts backwards from the next bar
            until = int(firsts[0]) - number if len(firsts) else 0
            rows.append((float(time), f"0.{heard.meter - until + 1}" if until else "beat"))
    rows.sort(key=lambda row: row[0])
    return "".join(f"{time:.6f}\t{time:.6f}\t{word}\n" for time, word in rows)


def _read(text: str) -> list[Entry]:
    """The lines that hold a time; a heading before the first one and remarks are passed over."""
    found: list[Entry] = []
    rows = text.split("\n")
    if _are_decimals(rows):
        rows = [row.replace(",", ".") for row in rows]
    for number, row in enumerate(rows, start=1):
        if not row.strip() or row.lstrip().startswith(("#", "\\", "//")):
            continue  # a backslash begins the pitches of a label of Audacity
        fields = _fields(row)
        time = seconds_of(fields[0])
        if time is None:
            if found or number > 3 or _is_number(fields[0]):
                raise ValueError(f"line {number}: {fields[0][:30]!r} is not a time")
            continue
        rest = fields[1:]
        if len(rest) > 1 and seconds_of(rest[0]) is not None:
            rest = rest[1:]  # where the label ends
        elif len(rest) == 1 and "\t" in row and _is_end(rest[0], time):
            rest = []  # a label of Audacity without a word
        found.append(Entry(number, time, " ".join(rest).strip()))
        if len(found) > MOST_BEATS:
            raise ValueError(f"holds more than {MOST_BEATS} times")
    return found


def _are_decimals(rows: list[str]) -> bool:
    """Whether lines such as `0,5` are times with a decimal comma, and not times with a place.

    A place in a bar is never 0, and times are not twice the same.
    """
    found = [_COMMA.fullmatch(row.strip()) for row in rows if row.strip()]
    if not found or None in found:
        return False
    pairs = [(int(one[1]), one[2]) for one in found if one]
    firsts = [first for first, _ in pairs]
    return len(set(firsts)) < len(firsts) or any(not int(second) for _, second in pairs)


def _is_number(field: str) -> bool:
    """Whether a field that is no time is a number all the same: no heading."""
    try:
        float(field)
    except ValueError:
        return False
    return True


def _is_end(field: str, time: float) -> bool:
    """Whether a lone second number of a line is a time, and not the place in a bar."""
    end = seconds_of(field)
    return end is not None and "." in field and end >= time


def _fields(row: str) -> list[str]:
    """The fields of a line; where semicolons or tabs part them a comma may stand in a number."""
    row = row.strip()
    for sign in ("\t", ";", ","):
        if sign in row:
            fields = [field.strip().strip('"') for field in row.split(sign)]
            if sign != "," and re.fullmatch(r"-?\d+,\d+", fields[0]):
                fields[0] = fields[0].replace(",", ".")
            return fields
    return row.split(None, 1)


def seconds_of(text: str) -> float | None:
    """A time as a number of seconds; None if it is none, below 0, or beyond all sounds.

    Args:
        text: `12.5`, `1:02.5` or `1:00:02.5`.
    """
    clock = _CLOCK.fullmatch(text)
    if clock:
        time = float(clock[1] or 0) * 3600 + float(clock[2]) * 60 + float(clock[3])
    else:
        try:
            time = float(text)
        except ValueError:
            return None
    return time if 0 <= time <= _MOST_TIME else None


def _place(word: str) -> int | None:
    """The beat of the bar that a word names."""
    match = _IN_BAR.fullmatch(word)
    return int(match[1] or match[2]) if match else None
