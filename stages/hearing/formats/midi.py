"""Beats from the tempos and bars of a MIDI file, and sections from its markers.

Source: Standard MIDI Files 1.0, MIDI Manufacturers Association (1988).
"""

from dataclasses import dataclass
from itertools import islice

import numpy as np

from stages.hearing.heard import MOST_BEATS, USUAL_METER, Heard, Mark, usual_bpm

_TEMPO, _TIME_SIGNATURE, _MARKER, _CUE, _END = 0x51, 0x58, 0x06, 0x07, 0x2F
_USUAL_TEMPO = 500_000
"""Microseconds of a quarter note where nothing is said: 120 bpm."""


@dataclass(frozen=True)
class _Event:
    """A meta event."""

    tick: int
    """When, in ticks from the start."""
    kind: int
    """Its number."""
    content: bytes
    """What it says."""


def from_midi(content: bytes) -> Heard:
    """Read tempos, bars and markers; notes say only how long the piece is.

    Args:
        content: The file.

    Raises:
        ValueError: If it is no MIDI file, or a damaged one.
    """
    if content[:4] != b"MThd" or len(content) < 14:
        raise ValueError("is no MIDI file")
    division = int.from_bytes(content[12:14], "big")
    events: list[_Event] = []
    last, place = 0, 8 + int.from_bytes(content[4:8], "big")
    while place + 8 <= len(content):
        name, size = content[place : place + 4], int.from_bytes(content[place + 4 : place + 8])
        if place + 8 + size > len(content):
            raise ValueError("breaks off within a track")
        if name == b"MTrk":
            found, end = _events(content[place + 8 : place + 8 + size])
            events += found
            last = max(last, end)
        place += 8 + size
    events.sort(key=lambda event: event.tick)
    clock = _Tempos.of(events, division)
    beats, downbeats = _beats(events, division, last)
    marks = [
        Mark(clock.seconds(event.tick), event.content.decode("utf-8", "replace").strip())
        for event in events
        if event.kind in (_MARKER, _CUE)
    ]
    times = clock.all_seconds(beats)
    return Heard(
        clock.seconds(last),
        usual_bpm(times),
        times,
        clock.all_seconds(downbeats),
        sections=tuple(marks),
        meter=_first_meter(events),
    )


@dataclass(frozen=True, eq=False)
class _Tempos:
    """From ticks to seconds."""

    ticks: np.ndarray
    """Where tempos begin, [N], the first at 0."""
    times: np.ndarray
    """When that is [s], [N]."""
    steps: np.ndarray
    """Length of a tick from there on [s], [N]."""

    @classmethod
    def of(cls, events: list[_Event], division: int) -> "_Tempos":
        """The clock of a file.

        Args:
            events: Its meta events, by tick.
            division: What its header says of ticks.
        """
        if division & 0x8000:  # ticks of film frames, whatever the tempo
            frames, parts = 256 - (division >> 8), division & 0xFF
            rate = 30000 / 1001 if frames == 29 else float(frames)
            return cls(np.zeros(1), np.zeros(1), np.array([1 / (rate * max(parts, 1))]))
        if not division:
            raise ValueError("has no ticks in a quarter note")
        tempos = {0: _USUAL_TEMPO}
        for event in events:
            if event.kind == _TEMPO and len(event.content) >= 3:
                tempos[event.tick] = int.from_bytes(event.content[:3], "big")
                if not tempos[event.tick]:
                    raise ValueError("has a tempo of 0 microseconds a quarter note")
        ticks = np.array(list(tempos), dtype=float)
        steps = np.array(list(tempos.values())) / (division * 1e6)
        times = np.concatenate([[0.0], np.cumsum(np.diff(ticks) * steps[:-1])])
        return cls(ticks, times, steps)

    def all_seconds(self, ticks: np.ndarray) -> np.ndarray:
        """Times of many ticks [s]."""
        place = np.searchsorted(self.ticks, ticks, side="right") - 1
        return self.times[place] + (ticks - self.ticks[place]) * self.steps[place]

    def seconds(self, tick: int) -> float:
        """The time of a tick [s]."""
        return float(self.all_seconds(np.array([tick]))[0])


def _events(track: bytes) -> tuple[list[_Event], int]:
    """Meta events of a track, and the tick at which it ends."""
    found: list[_Event] = []
    place, tick, status = 0, 0, 0
    while place < len(track):
        step, place = _length(track, place)
        tick += step
        if place >= len(track):
            raise ValueError("a track breaks off")
        if track[place] & 0x80:
            status = track[place]
            place += 1
        if status == 0xFF:
            kind = track[place] if place < len(track) else _END
            size, place = _length(track, place + 1)
            found.append(_Event(tick, kind, track[place : place + size]))
            place += size
            if kind == _END:
                break
        elif status in (0xF0, 0xF7):
            size, place = _length(track, place)
            place += size
        elif status & 0x80:
            place += 1 if status & 0xF0 in (0xC0, 0xD0) else 2
        else:
            raise ValueError("a track begins amid an event")
    return found, tick


def _length(track: bytes, place: int) -> tuple[int, int]:
    """A number of variable length, and the place behind it."""
    value = 0
    for byte in islice(track, place, place + 4):
        place += 1
        value = value << 7 | byte & 0x7F
        if not byte & 0x80:
            return value, place
    raise ValueError("a track breaks off")


def _beats(events: list[_Event], division: int, last: int) -> tuple[np.ndarray, np.ndarray]:
    """Ticks of beats and of downbeats, from one time signature to the next."""
    quarter = 480 if division & 0x8000 else division
    signs = {0: b"\x04\x02"}
    for event in events:
        if event.kind == _TIME_SIGNATURE and len(event.content) >= 2 and event.content[0]:
            signs[event.tick] = event.content[:2]
    starts = sorted(signs)
    beats: list[np.ndarray] = []
    downbeats: list[np.ndarray] = []
    for start, end in zip(starts, [*starts[1:], last + 1], strict=True):
        count, step = _in_bar(signs[start], quarter)
        if (end - start) / step > MOST_BEATS:
            raise ValueError(f"lasts longer than {MOST_BEATS} beats")
        beats.append(np.arange(start, end, step))
        downbeats.append(np.arange(start, end, step * count))
    return np.concatenate(beats), np.concatenate(downbeats)


def _in_bar(sign: bytes, quarter: int) -> tuple[int, float]:
    """Beats of a bar and ticks of a beat: three eighths are one beat in 6/8, 9/8 and 12/8."""
    count, step = sign[0], quarter * 4 / 2 ** min(sign[1], 6)
    if sign[1] >= 3 and count > 3 and count % 3 == 0:
        return count // 3, step * 3
    return count, step


def _first_meter(events: list[_Event]) -> int:
    for event in events:
        if event.kind == _TIME_SIGNATURE and len(event.content) >= 2 and event.content[0]:
            return _in_bar(event.content[:2], 1)[0]
    return USUAL_METER
