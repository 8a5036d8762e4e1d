"""How much begins to sound at each moment: the flux of spectra.

Source: Boeck and Widmer, Maximum filter vibrato suppression for onset detection (DAFx 2013).
Deviation: bands of bins are compared with those two spectra before, with no neighbours; what is
found is told in units of what is usual around it, so that quiet parts count as loud ones do.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from stages.hearing.listening.spectrum import FRAMES, Spectrum

LAG = 2
"""Spectra between those that are compared."""
LOUD = 0.98
"""The part of all magnitudes below the one that is taken for loud."""
DEPTH = 300.0
"""How far below a loud band one still counts: its logarithm bends there."""
LOW, HIGH = 160.0, 2500.0
"""Where the low bands end and the high ones begin [Hz]."""
AROUND = 4.0
"""Over how long it is found what is usual [s]."""
FAINT = 0.02
"""What rises by less than this, as a logarithm, is nothing: tones that beat together."""
_CHUNK = 4096
"""Spectra that are compared at once."""


@dataclass(frozen=True, eq=False)
class Rising:
    """How much begins, at every spectrum; all [N] float64."""

    whole: np.ndarray
    """In all bands, in units of what is usual around."""
    raw: np.ndarray
    """In all bands, per band, as logarithms rise."""
    low: np.ndarray
    """In the low bands: drums and bass."""
    mid: np.ndarray
    """In the middle bands."""
    high: np.ndarray
    """In the high bands: cymbals and hisses."""


def strength_of(spectrum: Spectrum) -> Rising:
    """Find how much begins.

    Args:
        spectrum: The sound.
    """
    bands = spectrum.bands
    loud = max(float(np.quantile(bands[:: max(1, len(bands) // 20000)], LOUD)), 1e-3)
    is_low, is_high = spectrum.centers < LOW, spectrum.centers >= HIGH
    groups = (is_low, ~is_low & ~is_high, is_high)
    found = np.zeros((len(bands), len(groups)))
    scale = np.float32(DEPTH / loud)
    for start in range(0, len(bands), _CHUNK):
        part = bands[max(0, start - LAG) : start + _CHUNK]
        if not start:
            part = np.pad(part, ((LAG, 0), (0, 0)))
        loudness = np.log1p(part * scale)
        rise = np.maximum(loudness[LAG:] - loudness[:-LAG], 0)
        for number, group in enumerate(groups):
            found[start : start + _CHUNK, number] = rise[:, group].mean(axis=1)
    shares = np.array([group.mean() for group in groups])
    raw = (found * shares).sum(axis=1)
    return Rising(unusual(raw), raw, found[:, 0], found[:, 1], found[:, 2])


def unusual(values: np.ndarray) -> np.ndarray:
    """Values in units of what is usual around them; what is below the mean is 0.

    Args:
        values: At every spectrum, [N].
    """
    wide = int(AROUND * FRAMES) | 1
    mean = uniform_filter1d(values, wide, mode="nearest")
    above = np.maximum(values - mean, 0)
    spread = np.sqrt(uniform_filter1d(above * above, wide, mode="nearest"))
    floor = max(0.1 * float(np.sqrt((above * above).mean())), FAINT)
    return np.asarray(above / np.maximum(spread, floor))


def peaks_of(values: np.ndarray, apart: int) -> np.ndarray:
    """Places of values that are the largest within some distance, [P] int.

    Args:
        values: At every spectrum, [N].
        apart: The distance [spectra].
    """
    largest = maximum_filter1d(values, 2 * apart + 1, mode="constant")
    return np.flatnonzero((values >= largest) & (values > 0))


def refined(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Places of peaks between spectra: the top of a parabola through three values, [P] float64.

    Args:
        values: At every spectrum, [N].
        places: Peaks.
    """
    inner = np.clip(places, 1, max(1, len(values) - 2))
    left, top, right = (values[np.clip(inner + d, 0, len(values) - 1)] for d in (-1, 0, 1))
    bend = left - 2 * top + right
    shift = np.where(bend < -1e-9, 0.5 * (left - right) / np.minimum(bend, -1e-9), 0.0)
    return places + np.clip(shift, -0.5, 0.5)
