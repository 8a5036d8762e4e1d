"""How strong something is over time."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Contour:
    """Values at even steps, from the time 0 on.

    Raises:
        ValueError: If the rate is not above 0.
    """

    rate: float
    """Values per second [Hz]; value i belongs to the time i / rate."""
    values: np.ndarray
    """Strengths, [N] float32, 0 to 1."""

    def __post_init__(self) -> None:
        if not self.rate > 0:
            raise ValueError(f"rate must be above 0, got {self.rate}")

    def at(self, time: float | np.ndarray) -> float | np.ndarray:
        """The strength at a time or at several, between two values on the line; 0 beyond the ends.

        Args:
            time: [s], a number or an array of any shape.
        """
        if not len(self.values):
            return np.zeros_like(time, dtype=float) if np.ndim(time) else 0.0
        place = np.asarray(time, dtype=float) * self.rate
        found = np.interp(place, np.arange(len(self.values)), self.values, left=0.0, right=0.0)
        return found if np.ndim(time) else float(found)
