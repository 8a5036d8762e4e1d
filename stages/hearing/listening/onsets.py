"""Onsets: moments at which something begins to sound."""

import numpy as np
from scipy.ndimage import median_filter

from stages.hearing.listening.strength import Rising, peaks_of, refined

APART = 4
"""Spectra between onsets at least."""
ABOVE, LEAST = 0.25, 0.1
"""An onset is above what is usual around it by this part of a strong one, and by this much."""
END = 6
"""Spectra at the end in which there is none: a sound that breaks off splashes over all bands."""
_AROUND = 31
"""Spectra over which it is found what is usual."""


def onsets_of(strength: Rising) -> np.ndarray:
    """Find onsets, as places between spectra, [O] float64.

    Args:
        strength: How much begins.
    """
    values = strength.raw
    strong = float(np.quantile(values, 0.98))
    if strong <= 0:
        return np.empty(0)
    usual = median_filter(values, _AROUND, mode="constant")
    places = peaks_of(values, APART)
    places = places[places < len(values) - END]
    chosen = values[places] > usual[places] + max(ABOVE * strong, LEAST)
    return refined(values, places[chosen])
