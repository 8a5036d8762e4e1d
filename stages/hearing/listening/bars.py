"""Downbeats: the beat of the bar at which most begins low and the harmony changes."""

import numpy as np
from scipy.ndimage import maximum_filter1d

from stages.hearing.listening.spectrum import FRAMES, LONG_HOP, RATE, Spectrum
from stages.hearing.listening.strength import Rising

CHANGE = 1.5
"""What a change of the harmony counts, beside the low bands."""
JUMP = 16.0
"""What it costs that a bar has another number of beats, in units of what is usual at a beat."""
_NEAR = 3
"""Spectra around a beat in which it is looked for."""


def downbeats_of(spectrum: Spectrum, strength: Rising, beats: np.ndarray, meter: int) -> np.ndarray:
    """Find the first beats of bars, as numbers of beats, [D] int.

    Args:
        spectrum: The sound.
        strength: How much begins.
        beats: Beats, as places between spectra, [B].
        meter: Beats of a bar.
    """
    if len(beats) < 2 or meter < 2:
        return np.arange(len(beats))
    near = maximum_filter1d(strength.low, 2 * _NEAR + 1)
    low = near[np.clip(beats.round().astype(int), 0, len(near) - 1)]
    evidence = _usual(low) + CHANGE * _usual(_changes(spectrum.tones, beats, meter - 1))
    return np.flatnonzero(_places(evidence, meter) == 0)


def _changes(tones: np.ndarray, beats: np.ndarray, back: int) -> np.ndarray:
    """How much the harmony of each beat differs from that of some before it, [B], 0 to 1."""
    edges = beats / FRAMES * (RATE / LONG_HOP)
    step = float(np.median(np.diff(edges)))
    loud = max(float(np.quantile(tones, 0.99)), 1e-6)
    loudness = np.log1p(tones * (30.0 / loud))
    total = np.concatenate(
        [np.zeros((1, tones.shape[1])), np.cumsum(loudness, axis=0, dtype=float)]
    )

    def until(places: np.ndarray) -> np.ndarray:
        """Sums up to some places, between rows on the line."""
        inside = np.clip(places, 0, len(tones))
        row = np.minimum(inside.astype(int), len(tones) - 1)
        return np.asarray(total[row] + (inside - row)[:, None] * (total[row + 1] - total[row]))

    before = until(edges) - until(edges - back * step)
    after = until(edges + step) - until(edges)
    same = (before * after).sum(axis=1)
    size = np.sqrt((before**2).sum(axis=1) * (after**2).sum(axis=1))
    return np.where(size > 1e-9, 1 - same / np.maximum(size, 1e-9), 0.0)


def _usual(values: np.ndarray) -> np.ndarray:
    """Values in units of their spread, around their mean."""
    spread = float(values.std())
    return np.zeros(len(values)) if spread < 1e-9 else (values - values.mean()) / spread


def _places(evidence: np.ndarray, meter: int) -> np.ndarray:
    """The place in its bar of every beat, from 0, [B]: most evidence at places 0."""
    best = np.zeros(meter)
    best[0] = evidence[0]
    came = np.zeros((len(evidence), meter), np.int64)
    for number in range(1, len(evidence)):
        jump = int(best.argmax())
        goes_on = np.roll(best, 1)
        jumps = best[jump] - JUMP > goes_on
        came[number] = np.where(jumps, jump, np.roll(np.arange(meter), 1))
        best = np.where(jumps, best[jump] - JUMP, goes_on)
        best[0] += evidence[number]
    places = np.zeros(len(evidence), np.int64)
    places[-1] = int(best.argmax())
    for number in range(len(evidence) - 1, 0, -1):
        places[number - 1] = came[number, places[number]]
    return places
