"""Beats: moments a period apart at which much begins, by dynamic programming.

Source: Ellis, Beat Tracking by Dynamic Programming, Journal of New Music Research 36 (2007).
Deviation: the period is that of the tempo around each moment.
"""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from stages.hearing.listening.spectrum import FRAMES
from stages.hearing.listening.strength import refined

TIGHTNESS = 300.0
"""What it costs that beats are not a period apart."""
NEAR = 3
"""Spectra around a beat among which the one is taken at which most begins."""


def beats_of(strength: np.ndarray, bpm: np.ndarray) -> np.ndarray:
    """Find beats, as places between spectra, [B] float64.

    Args:
        strength: How much begins at every spectrum, [N].
        bpm: Beats a minute around every spectrum, [N].
    """
    wanted = gaussian_filter1d(strength, 1.5)
    wanted = wanted / max(1e-9, float(wanted.std()))
    periods = 60 * FRAMES / bpm
    score, came = _chained(wanted, periods)
    last = int(periods[-1])
    place = len(score) - last + int(score[-last:].argmax()) if last < len(score) else -1
    if place < 0:
        return np.empty(0)
    found = []
    while place >= 0:
        found.append(place)
        place = int(came[place])
    return _settled(wanted, np.array(found[::-1]))


def _chained(wanted: np.ndarray, periods: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The best sum that ends at each spectrum, and the beat before it, -1 for none."""
    count = len(wanted)
    score, came = wanted.copy(), np.full(count, -1, np.int64)
    tables: dict[int, tuple[int, np.ndarray]] = {}
    for place in range(count):
        key = int(periods[place] * 4)
        if key not in tables:
            period = key / 4
            steps = np.arange(round(period / 2), round(period * 2) + 1)
            tables[key] = int(steps[-1]), -TIGHTNESS * np.log(steps[::-1] / period) ** 2
        longest, cost = tables[key]
        start = place - longest
        end = start + len(cost)
        if end <= 0:
            continue
        known = score[max(start, 0) : end] + cost[max(0, -start) :]
        best = int(known.argmax())
        if known[best] > 0:
            came[place] = max(start, 0) + best
            score[place] += known[best]
    return score, came


def _settled(wanted: np.ndarray, beats: np.ndarray) -> np.ndarray:
    """Beats moved to where most begins near by."""
    shifts = np.arange(-NEAR, NEAR + 1)
    around = wanted[np.clip(beats[:, None] + shifts, 0, len(wanted) - 1)]
    around = around * (1 - 0.05 * np.abs(shifts))
    moved = beats + shifts[around.argmax(axis=1)]
    return refined(wanted, moved)
