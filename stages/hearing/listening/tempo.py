"""The tempo around each moment, which may drift.

In windows it is seen how well what begins repeats after each time; of all courses of the tempo the
one is taken that repeats best and changes least.
"""

from dataclasses import dataclass

import numpy as np
from scipy.fft import irfft, rfft

from stages.hearing.listening.spectrum import FRAMES

SLOWEST, FASTEST = 50.0, 220.0
"""Beats a minute that are looked for."""
USUAL, OCTAVES = 120.0, 0.9
"""What people tap most often, and how far around it [octaves]."""
STEP = 0.01
"""From one tempo to the next, as a part of it."""
WINDOW, EVERY = 8.0, 1.0
"""Length of the windows, and from one to the next [s]."""
MULTIPLES = (1.0, 0.7, 0.5, 0.5)
"""What repeating after one, two, three and four beats counts."""
STIFFNESS = 0.5
"""What a change of the tempo by one step from one window to the next costs."""
MOST_STEPS = 4
"""Steps by which the tempo changes from one window to the next, at most."""
HINT = 0.04
"""How far a tempo may be from the one that was said, as a part of it."""


@dataclass(frozen=True, eq=False)
class Tempo:
    """Beats a minute over time."""

    bpm: np.ndarray
    """At every spectrum, [N]."""
    clarity: float
    """How well it repeats, 0 to 1."""


def tempo_of(strength: np.ndarray, bpm: float | None = None) -> Tempo:
    """Find the tempo around each moment.

    Args:
        strength: How much begins at every spectrum, [N].
        bpm: About the tempo, if it is known.
    """
    tempos = _tempos(bpm)
    windows, middles = _windows(strength)
    repeats = _repeats(windows)
    lags = 60 * FRAMES / tempos
    score, single = np.zeros((len(windows), len(tempos))), np.zeros((len(windows), len(tempos)))
    for number, weight in enumerate(MULTIPLES, start=1):
        found = _at(repeats, number * lags)
        score += weight * found
        single = np.maximum(single, found)
    score /= sum(MULTIPLES)
    prior = np.exp(-0.5 * (np.log2(tempos / (bpm or USUAL)) / OCTAVES) ** 2)
    course = _course(np.maximum(score, 0) * prior)
    rows = np.arange(len(windows))
    loud = windows.std(axis=1)
    clarity = float((single[rows, course] * loud).sum() / max(1e-9, loud.sum()))
    places = np.arange(len(strength))
    logs = np.interp(places, middles, np.log(tempos[course]))
    return Tempo(np.exp(logs), clarity)


def _tempos(bpm: float | None) -> np.ndarray:
    """Tempos that are looked for."""
    low, high = (SLOWEST, FASTEST) if bpm is None else (bpm * (1 - HINT), bpm * (1 + HINT))
    count = max(2, round(np.log(high / low) / STEP))
    return np.geomspace(low, high, count + 1)


def _windows(strength: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Windows of what begins, [K, L], tapered, and their middles [spectra]."""
    size, hop = int(WINDOW * FRAMES), int(EVERY * FRAMES)
    padded = np.pad(strength, (size // 2, size // 2 + hop))
    count = max(1, -(-len(strength) // hop))
    views = np.lib.stride_tricks.sliding_window_view(padded, size)[::hop][:count]
    return views * np.hanning(size), np.arange(len(views)) * float(hop)


def _repeats(windows: np.ndarray) -> np.ndarray:
    """How well windows repeat after each time, 1 after none, [K, L]; less for silence."""
    size = windows.shape[1]
    centred = windows - windows.mean(axis=1, keepdims=True) * 0.5
    spread = rfft(centred, 2 * size, axis=1)
    found = irfft(np.abs(spread) ** 2, axis=1)[:, :size]
    taper = irfft(np.abs(rfft(np.hanning(size), 2 * size)) ** 2)[:size]
    fewer = taper[0] / np.maximum(taper, 0.05 * taper[0])
    return np.asarray(found / np.maximum(found[:, :1], 1e-9) * fewer)


def _at(repeats: np.ndarray, lags: np.ndarray) -> np.ndarray:
    """Values between times, [K, T]: the largest of three near by, for beats are never exact."""
    found = np.full((len(repeats), len(lags)), -1.0)
    for shift in (-1.0, 0.0, 1.0):
        place = np.clip(lags + shift, 0, repeats.shape[1] - 2)
        low = place.astype(int)
        share = place - low
        near = repeats[:, low] * (1 - share) + repeats[:, low + 1] * share
        found = np.maximum(found, near)
    return found


def _course(score: np.ndarray) -> np.ndarray:
    """The best way through the windows, [K]: one tempo each."""
    count, width = score.shape
    best = score[0].copy()
    came = np.zeros((count, width), np.int64)
    steps = np.arange(-MOST_STEPS, MOST_STEPS + 1)
    cost = 0.02 * STIFFNESS * steps**2
    for row in range(1, count):
        padded = np.pad(best, MOST_STEPS, constant_values=-np.inf)
        moved = np.lib.stride_tricks.sliding_window_view(padded, width) - cost[:, None]
        chosen = moved.argmax(axis=0)
        came[row] = np.clip(np.arange(width) + steps[chosen], 0, width - 1)
        best = moved[chosen, np.arange(width)] + score[row]
    course = np.zeros(count, np.int64)
    course[-1] = int(best.argmax())
    for row in range(count - 1, 0, -1):
        course[row - 1] = came[row, course[row]]
    return course
