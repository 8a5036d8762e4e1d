"""Flashes: whether a film's brightness goes up and down more often than is safe to look at."""

from dataclasses import dataclass, replace
from fractions import Fraction

import cv2
import numpy as np

from stages.media.color.yuv import over_paper

CELLS = 128
"""Cells along the longer side of the picture; what is finer than a cell is taken for a texture."""
CHANGE = 0.1
"""Least change of relative luminance that belongs to a flash [part of white's]."""
BRIGHT = 0.8
"""Changes between brighter pictures than this are harmless [part of white's luminance]."""
CHANGES = 7
"""So many opposing changes are more than three flashes, of which each is two."""
PERIOD = 1.0
"""Within so long [s]."""
AREA = 0.25
"""Flashes over no more than this part of the picture are harmless."""
_TINY = 1e-6
"""Times of frames are fractions; rounded, they are this exact [s]."""
_CODES = np.arange(256) / 255.0
_LIGHT = np.where(_CODES <= 0.04045, _CODES / 12.92, ((_CODES + 0.055) / 1.055) ** 2.4).astype("f4")
"""Linear light of sRGB's code values."""
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722], dtype=np.float32)
"""What red, green and blue light add to relative luminance."""


@dataclass(frozen=True)
class Flashing:
    """A part of a film that flashes."""

    begins: float
    """The first change [s from the start of the source]."""
    ends: float
    """The last one [s]."""
    rate: float
    """Flashes a second, where there are most."""
    area: float
    """Part of the picture that flashes, where it is most."""

    def joined(self, later: "Flashing") -> "Flashing":
        """This and what follows it, as one."""
        ends, rate = max(self.ends, later.ends), max(self.rate, later.rate)
        return Flashing(min(self.begins, later.begins), ends, rate, max(self.area, later.area))


@dataclass(frozen=True)
class Flashes:
    """The parts of a film that flash: the first one, and how many there are."""

    first: Flashing
    """The first part."""
    last: Flashing
    """The last part."""
    count: int = 1
    """How many there are."""

    def followed_by(self, found: Flashing) -> "Flashes":
        """These and a later one; what begins within a second of the last is a part of it."""
        if found.begins > self.last.ends + PERIOD:
            return replace(self, last=found, count=self.count + 1)
        last = self.last.joined(found)
        return Flashes(last if self.count == 1 else self.first, last, self.count)

    @property
    def note(self) -> str:
        """What is told of them, one sentence."""
        first, others = self.first, self.count - 1
        more = f" and {others} more time{'s' * (others > 1)} up to {_clock(self.last.ends)}"
        return (
            f"the film flashes {max(4, round(first.rate))} times a second from "
            f"{_clock(first.begins)} to {_clock(first.ends)}, over {100 * first.area:.0f} % of the "
            f"picture{more if others else ''}: more than three (WCAG 2.3.1) are a danger to people "
            "with photosensitive epilepsy; let less change, or more slowly, as the timeline "
            "strobe-safe does"
        )


class FlashWatch:
    """Looks at the pictures of a film, one by one, for flashes.

    A flash is a pair of opposing changes of relative luminance by at least a tenth of white's, of
    which the darker picture is below 0.8. A place flashes if it changes seven times within less
    than a second; a film if a quarter of its places do so at once. Every place is followed by
    itself from one turn of its brightness to the next, so that a change may take many frames, and
    any frame rate will do. What is kept does not grow with the film.

    Source: WCAG 2.2, success criterion 2.3.1, general flash threshold.
    Deviation: a quarter of the picture stands for a quarter of any ten degrees of vision, for
        nobody knows how the film will be looked at; flashes of saturated red count by their
        luminance alone; a seventh change counts, though it only begins the fourth flash.
    """

    def __init__(self) -> None:
        self.found: Flashes | None = None
        """What flashes, as far as the film was seen."""
        # of every cell: extremes since its last turn, that turn's sign, and when it changed [s]
        self._low = self._high = np.zeros((0, 0), dtype=np.float32)
        self._sign = np.zeros((0, 0), dtype=np.int8)
        self._times = np.zeros((CHANGES, 0, 0))

    def add(self, pixels: np.ndarray, time: Fraction) -> None:
        """Look at a picture.

        Args:
            pixels: Code values, [H, W, 3] uint8, or [H, W, 4] with straight alpha: over paper;
                of one size for all pictures.
            time: When it is shown [s]; later than the one before.
        """
        light, now = _luminance(pixels), float(time)
        if light.shape != self._low.shape:
            self._low, self._high = light.copy(), light.copy()
            self._sign = np.zeros(light.shape, dtype=np.int8)
            self._times = np.full((CHANGES, *light.shape), -np.inf)
            return
        rises = (self._sign <= 0) & (light - self._low >= CHANGE) & (self._low < BRIGHT)
        falls = (self._sign >= 0) & (self._high - light >= CHANGE) & (light < BRIGHT)
        turns = rises | falls
        self._sign[rises], self._sign[falls & ~rises] = 1, -1
        self._low = np.where(turns, light, np.minimum(self._low, light))
        self._high = np.where(turns, light, np.maximum(self._high, light))
        if turns.any():
            self._times[:-1, turns] = self._times[1:, turns]
            self._times[-1, turns] = now
            self._judge(now)

    def _judge(self, now: float) -> None:
        """Find out whether enough of the picture flashes."""
        flashing = now - self._times[0] < PERIOD - _TINY
        area = float(flashing.mean())
        if area <= AREA:
            return
        earliest, latest = self._times[0, flashing], self._times[-1, flashing]
        rate = (CHANGES - 1) / 2 / float(np.median(latest - earliest))
        found = Flashing(float(earliest.min()), float(latest.max()), rate, area)
        known = self.found
        self.found = Flashes(found, found) if known is None else known.followed_by(found)


def _luminance(pixels: np.ndarray) -> np.ndarray:
    """Relative luminance of a picture's cells [0..1], [h, w] float32."""
    height, width = pixels.shape[:2]
    scale = min(1.0, CELLS / max(height, width))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    small = cv2.resize(pixels, size, interpolation=cv2.INTER_AREA)
    shown = over_paper(small) if small.shape[2] == 4 else small
    return _LIGHT[shown] @ _LUMINANCE


def _clock(seconds: float) -> str:
    """A time as minutes and seconds."""
    minutes, rest = divmod(round(seconds, 1), 60)
    return f"{int(minutes)}:{rest:04.1f}"
