"""How strong a sound and its bands are over time."""

import numpy as np

from stages.hearing.contour import Contour
from stages.hearing.listening.spectrum import FRAMES, Spectrum
from stages.hearing.listening.strength import HIGH, LOW

ENVELOPE_RATE = 50.0
"""Values a second [Hz]."""
LOUDNESS = 0.6
"""Loudness is that power of the sound's pressure."""
FULL = 0.995
"""The part of all values below the one that becomes 1."""
SILENCE = 1e-4
"""Below this root mean square nothing is heard."""
_DARK, _BRIGHT = 100.0, 8000.0
"""Middles of spectra that become 0 and 1 [Hz]."""


def envelopes_of(spectrum: Spectrum) -> dict[str, Contour]:
    """Strengths from 0 to 1, by the names of `Heard.envelopes`.

    Source: Stevens, The measurement of loudness, J. Acoust. Soc. Am. 27 (1955), for the power.

    Args:
        spectrum: The sound.
    """
    centers = spectrum.centers
    groups = {
        "low": centers < LOW,
        "mid": (centers >= LOW) & (centers < HIGH),
        "high": centers >= HIGH,
    }
    is_heard = spectrum.rms > SILENCE
    found = {"loudness": _loudness(spectrum.rms, is_heard)}
    for name, group in groups.items():
        power = np.square(spectrum.bands[:, group]).sum(axis=1)
        found[name] = _loudness(np.sqrt(power), is_heard)
    pitch = np.log(np.maximum(spectrum.centroid, _DARK) / _DARK) / np.log(_BRIGHT / _DARK)
    found["centroid"] = np.where(is_heard, pitch, 0.0)
    step = round(FRAMES / ENVELOPE_RATE)
    return {name: Contour(ENVELOPE_RATE, _every(one, step)) for name, one in found.items()}


def _loudness(pressure: np.ndarray, is_heard: np.ndarray) -> np.ndarray:
    """Pressure as it is heard, 1 for what is loud in this sound."""
    if not is_heard.any():
        return np.zeros(len(pressure))
    full = max(float(np.quantile(pressure[is_heard], FULL)), 1e-9)
    return np.where(is_heard, np.minimum(pressure / full, 1.0) ** LOUDNESS, 0.0)


def _every(values: np.ndarray, step: int) -> np.ndarray:
    """Means around every so many values, [N] float32, 0 to 1."""
    padded = np.pad(values, (step // 2, step), mode="edge")
    sums = np.cumsum(np.concatenate([[0.0], padded]))
    starts = np.arange(0, len(values), step)
    means = (sums[starts + step] - sums[starts]) / step
    return np.clip(means, 0, 1).astype(np.float32)
