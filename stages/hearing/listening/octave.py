"""Whether people would tap twice as fast as what repeats best, or half as fast."""

import numpy as np
from scipy.ndimage import maximum_filter1d

from stages.hearing.listening.strength import Rising

EQUAL, WEAK = 0.65, 0.45
"""What is midway between beats is a beat, too, if it is as strong as this part of one; every second
beat is none if it is weaker than this part of the others."""
SLOWEST, FASTEST = 60.0, 185.0
"""Beats a minute beyond which the tempo is not halved or doubled."""
_NEAR = 3
"""Spectra around a moment in which it is looked for."""


def octave_of(strength: Rising, beats: np.ndarray, bpm: float) -> float:
    """By what the tempo is to be multiplied: 2, 1 or 0.5.

    Cymbals keep time between beats as loudly as on them, so the low and the middle bands decide.

    Args:
        strength: How much begins.
        beats: Beats, as places between spectra.
        bpm: Beats a minute.
    """
    if len(beats) < 5:
        return 1.0
    body = 0.5 * (strength.low + strength.mid)
    body = np.maximum(body - np.median(body), 0)
    on, midway = _at(body, beats), _at(body, 0.5 * (beats[1:] + beats[:-1]))
    if 2 * bpm <= FASTEST and np.median(midway) > EQUAL * np.median(on):
        return 2.0
    even, odd = float(np.median(on[::2])), float(np.median(on[1::2]))
    return 0.5 if 0.5 * bpm >= SLOWEST and min(even, odd) < WEAK * max(even, odd) else 1.0


def _at(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """The largest of the values around some places."""
    near = maximum_filter1d(values, 2 * _NEAR + 1)
    return np.asarray(near[np.clip(places.round().astype(int), 0, len(values) - 1)])
