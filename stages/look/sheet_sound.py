"""A sound as a picture: lines of its wave, with beats, bars, onsets and sections."""

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np

from stages.hearing.heard import Heard

WIDTH = 1600
"""Columns of the picture [px]."""
PAPER, INK, FAINT = (250, 250, 248), (40, 40, 44), (226, 226, 224)
"""Ground, letters and ruled lines [code values]."""
BEAT, BAR, ONSET = (176, 182, 190), (206, 92, 60), (88, 134, 184)
"""Colours of marks [code values]."""
WAVE = ((172, 196, 222), (62, 104, 158))
"""Colours of peaks and of what is usual [code values]."""
HUES = ((88, 134, 184), (214, 138, 78), (112, 164, 106), (176, 112, 168), (196, 174, 82))
"""Colours of sections in turn [code values]."""
STRIPS = (("low", (168, 74, 56)), ("mid", (176, 136, 48)), ("high", (58, 128, 120)))
"""Bands below the wave, and their colours where they are loud [code values]."""
EDGE, LEFT, TOP = 24, 60, 92
"""Border, room for names at the left of a line, and room for the heading [px]."""
BAND, NAMES, HEIGHT, MARKS, STRIP, SPACE = 20, 16, 96, 12, 8, 26
"""Heights of a line's sections, numbers of bars, wave, onsets and bands, and between lines [px]."""
LINE, MOST_LINES = 40.0, 10
"""Seconds of a line, and lines at most; beyond them lines become longer."""
FINE = 16
"""Parts of a pixel in which marks are placed: `1 << 4`."""


@dataclass(frozen=True, eq=False)
class _Line:
    """A stretch of the sound and where it is drawn."""

    begin: float
    """Where it begins [s]."""
    seconds: float
    """How long it is [s]."""
    top: int
    """Its first row [px]."""
    has_sections: bool
    """Whether names of sections stand above it."""

    @property
    def wave(self) -> int:
        """First row of the wave."""
        return self.top + (BAND + 4 if self.has_sections else 0) + NAMES

    @property
    def width(self) -> int:
        """Its columns."""
        return WIDTH - LEFT - EDGE

    def x(self, time: float) -> float:
        """The column of a time [px]."""
        return LEFT + (time - self.begin) / self.seconds * self.width

    def shown(self, times: np.ndarray) -> np.ndarray:
        """Those of some times that lie in it [s]."""
        return times[(times >= self.begin) & (times < self.begin + self.seconds)]


def sheet_of_sound(heard: Heard, wave: np.ndarray, rate: float, title: str) -> np.ndarray:
    """Draw a sound.

    Args:
        heard: Its beats, bars, onsets, envelopes and sections.
        wave: Its peaks and root mean squares, [N, 2].
        rate: How many of them there are in a second [Hz].
        title: What stands on top.

    Returns:
        Code values, [rows, columns, 3] uint8.
    """
    total = max(heard.duration, 0.1)
    count = min(MOST_LINES, max(1, int(np.ceil(total / LINE))))
    seconds = total / count
    has_sections = bool(heard.sections)
    tall = (BAND + 4 if has_sections else 0) + NAMES + HEIGHT + MARKS + 3 * (STRIP + 1) + SPACE
    sheet = np.full((TOP + count * tall + EDGE // 2, WIDTH, 3), PAPER, np.uint8)
    _heading(sheet, heard, title)
    full = max(float(wave[:, 0].max(initial=0.0)), 1e-6)
    for number in range(count):
        line = _Line(number * seconds, seconds, TOP + number * tall, has_sections)
        _wave(sheet, line, wave / full, rate)
        _beats(sheet, line, heard)
        _onsets(sheet, line, heard)
        _strips(sheet, line, heard)
        _sections(sheet, line, heard)
        _times(sheet, line)
    return sheet


def _heading(sheet: np.ndarray, heard: Heard, title: str) -> None:
    """Name, figures and what colours mean."""
    _write(sheet, title, (LEFT, EDGE + 18), 0.75)
    told = [f"{_clock(heard.duration)}"]
    if heard.bpm is not None:
        told.append(f"{heard.bpm:.1f} beats a minute, {heard.meter} a bar")
    counts = ((heard.beats, "beats"), (heard.downbeats, "bars"), (heard.onsets, "onsets"))
    told += [f"{len(times)} {name}" for times, name in counts]
    _write(sheet, "   ".join(told), (LEFT, EDGE + 42), 0.45, (96, 96, 100))
    x = WIDTH - EDGE - 560
    for name, color in (("bar", BAR), ("beat", BEAT), ("onset", ONSET), *STRIPS):
        cv2.rectangle(sheet, (x, EDGE + 8), (x + 10, EDGE + 18), color, -1, cv2.LINE_AA)
        _write(sheet, name, (x + 16, EDGE + 18), 0.42, (96, 96, 100))
        x += 36 + 9 * len(name) + 12


def _wave(sheet: np.ndarray, line: _Line, wave: np.ndarray, rate: float) -> None:
    """Peaks, and what is usual darker in them, on both sides of a line."""
    edges = (line.begin + np.arange(line.width + 1) / line.width * line.seconds) * rate
    places = np.clip(edges.astype(int), 0, len(wave))
    middle = line.wave + HEIGHT // 2
    rows = np.abs(np.arange(HEIGHT) + 0.5 - HEIGHT / 2)[:, None]
    part = sheet[line.wave : line.wave + HEIGHT, LEFT : LEFT + line.width]
    peaks, usual = np.zeros(line.width), np.zeros(line.width)
    for column in range(line.width):
        found = wave[places[column] : max(places[column] + 1, places[column + 1])]
        if len(found):
            peaks[column], usual[column] = found[:, 0].max(), found[:, 1].mean()
    for values, color in ((peaks, WAVE[0]), (usual, WAVE[1])):
        share = np.clip(values[None, :] * (HEIGHT / 2 - 2) - rows + 0.5, 0, 1)[..., None]
        part[:] = np.rint(part + share * (np.array(color) - part))
    cv2.line(sheet, (LEFT, middle), (LEFT + line.width - 1, middle), WAVE[1], 1)


def _beats(sheet: np.ndarray, line: _Line, heard: Heard) -> None:
    """Lines through the wave, stronger where bars begin, which are numbered."""
    bottom = line.wave + HEIGHT
    gap = line.width / line.seconds * _step(heard.beats)
    if gap >= 5:
        for time in line.shown(heard.beats):
            _upright(sheet, line.x(float(time)), line.wave, bottom, BEAT, 0.8)
    free = 0.0
    for number, time in enumerate(heard.downbeats, start=1):
        if not line.begin <= time < line.begin + line.seconds:
            continue
        x = line.x(float(time))
        _upright(sheet, x, line.wave - 4, bottom, BAR, 0.9)
        if x >= free:
            _write(sheet, str(number), (round(x) - 3, line.wave - 6), 0.36, BAR)
            free = x + 8 * len(str(number)) + 14


def _onsets(sheet: np.ndarray, line: _Line, heard: Heard) -> None:
    """Short marks below the wave."""
    top = line.wave + HEIGHT + 3
    for time in line.shown(heard.onsets):
        _upright(sheet, line.x(float(time)), top, top + MARKS - 5, ONSET, 1.0)


def _strips(sheet: np.ndarray, line: _Line, heard: Heard) -> None:
    """How loud the bands are, as strips that take on colour."""
    times = line.begin + (np.arange(line.width) + 0.5) / line.width * line.seconds
    for number, (name, color) in enumerate(STRIPS):
        top = line.wave + HEIGHT + MARKS + number * (STRIP + 1)
        part = sheet[top : top + STRIP, LEFT : LEFT + line.width]
        part[:] = FAINT
        if name in heard.envelopes:
            share = np.asarray(heard.envelopes[name].at(times))[None, :, None] ** 1.5
            part[:] = np.rint(part + share * (np.array(color) - part))
        _write(sheet, name, (EDGE, top + STRIP), 0.32, (130, 130, 134))


def _sections(sheet: np.ndarray, line: _Line, heard: Heard) -> None:
    """Bands with names above the wave."""
    begins = [mark.time for mark in heard.sections]
    for number, mark in enumerate(heard.sections):
        end = begins[number + 1] if number + 1 < len(begins) else heard.duration
        left = max(line.x(mark.time), LEFT)
        right = min(line.x(end), LEFT + line.width)
        if right - left < 1:
            continue
        hue = HUES[number % len(HUES)]
        sheet[line.top : line.top + BAND, round(left) : round(right)] = hue
        room = int((right - left - 10) // 8)
        name = mark.name if len(mark.name) <= room else mark.name[: max(0, room - 1)] + "."
        if room > 2:
            _write(sheet, name, (round(left) + 6, line.top + 14), 0.42, (255, 255, 255))


def _times(sheet: np.ndarray, line: _Line) -> None:
    """Seconds along the bottom, and the time at which a line begins."""
    _write(sheet, _clock(line.begin), (EDGE - 8, line.wave + HEIGHT // 2 + 4), 0.38)
    bottom = line.wave + HEIGHT + MARKS + 3 * (STRIP + 1)
    for time in _round_times(line):
        x = round(line.x(time))
        cv2.line(sheet, (x, bottom), (x, bottom + 3), (150, 150, 154), 1)
        _write(sheet, _clock(time), (x + 3, bottom + 10), 0.32, (130, 130, 134))


def _round_times(line: _Line) -> Iterator[float]:
    """Times of a line that are multiples of some seconds, not too near to each other."""
    steps = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0, 600.0, 3600.0)
    step = next((one for one in steps if one / line.seconds * line.width >= 70), steps[-1])
    last = int((line.begin + line.seconds) / step)
    for number in range(int(np.ceil(line.begin / step)), last + 1):
        if line.x(number * step) < LEFT + line.width - 30:
            yield number * step


def _step(times: np.ndarray) -> float:
    """The usual time between two [s]."""
    return float(np.median(np.diff(times))) if len(times) > 1 else 1.0


def _upright(
    sheet: np.ndarray, x: float, top: int, bottom: int, color: tuple[int, int, int], share: float
) -> None:
    """A line of one pixel's width from a row to another, between columns."""
    left = int(np.floor(x))
    for column, part in ((left, 1 - (x - left)), (left + 1, x - left)):
        if 0 <= column < sheet.shape[1]:
            rows = sheet[top:bottom, column]
            rows[:] = np.rint(rows + share * part * (np.array(color) - rows))


def _clock(seconds: float) -> str:
    """`1:02`, or `0:01.5` where it is no whole second."""
    minutes, rest = divmod(round(seconds, 1), 60)
    return f"{int(minutes)}:{rest:04.1f}".removesuffix(".0")


def _write(
    sheet: np.ndarray,
    text: str,
    at: tuple[int, int],
    size: float,
    color: tuple[int, int, int] = INK,
) -> None:
    plain = text.encode("ascii", "replace").decode()
    cv2.putText(sheet, plain, at, cv2.FONT_HERSHEY_DUPLEX, size, color, 1, cv2.LINE_AA)
