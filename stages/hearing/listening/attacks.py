"""Moments moved to where a sound sets in: spectra see a loud beginning before it is there.

A window that ends in the first samples of a drum holds much of what it held before and a little of
the drum; where loudness counts by its logarithm that little is much. Power in steps of a few
milliseconds tells when it was.
"""

import numpy as np

from stages.hearing.listening.spectrum import STEPS, Spectrum

REACH = 0.032
"""How far a moment may be moved [s]."""
SPAN = 4
"""Steps before and after a moment whose power is compared: 10 ms."""
FLOOR = 0.1
"""The part of the largest power around that counts as nothing."""
CLEAR = 1.0
"""How much power has to rise, as a logarithm, for a moment to be moved."""


def set_in(spectrum: Spectrum, times: np.ndarray) -> np.ndarray:
    """Move moments to where power rises most near by, if it clearly does.

    Args:
        spectrum: The sound.
        times: Moments, ascending [s], [M].

    Returns:
        Moments, ascending [s], [M].
    """
    reach = round(REACH * STEPS)
    shifts = np.arange(-reach, reach + 1)
    places = np.rint(times * STEPS).astype(int)[:, None] + shifts
    rise = sum((_rise(power, places) for power in spectrum.powers.T), np.zeros(places.shape))
    best = rise.argmax(axis=1)
    is_clear = rise[np.arange(len(times)), best] > CLEAR
    moved = np.where(is_clear, places[np.arange(len(times)), best] / STEPS, times)
    return np.maximum.accumulate(moved)


def _rise(power: np.ndarray, places: np.ndarray) -> np.ndarray:
    """By how much the logarithm of power rises at some places, [M, S]."""
    sums = np.concatenate([[0.0], np.cumsum(power, dtype=np.float64)])
    here, after, before = (
        sums[np.clip(places + shift, 0, len(power))] for shift in (0, SPAN, -SPAN)
    )
    later, earlier = after - here, here - before
    floor = FLOOR * later.max(axis=1, keepdims=True) + 1e-9
    return np.asarray(np.log((later + floor) / (earlier + floor)))
