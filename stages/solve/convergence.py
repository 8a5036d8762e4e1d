"""When an optimisation has arrived: the rule that all of them share."""

LEAST_SAVING = 2e-4
"""Part of the energy that a round must save, for a picture on its own."""
PATIENCE = 3
"""Rounds that may save less, one after the other: one alone may have been a step too far."""


class Convergence:
    """Watches the energy of a mesh whose number of triangles does not change any more.

    Args:
        least_saving: A round that saves less than this part of the energy is idle.
        patience: Idle rounds in a row after which nothing more is expected.
    """

    def __init__(self, least_saving: float = LEAST_SAVING, patience: int = PATIENCE) -> None:
        self._least_saving = least_saving
        self._patience = patience
        self._best = float("inf")
        self._idle = 0

    def is_reached(self, energy: float) -> bool:
        """Take the energy after a round [code value^2 px]; whether to stop."""
        if energy < (1.0 - self._least_saving) * self._best:
            self._best, self._idle = energy, 0
        else:
            self._idle += 1
        return self._idle >= self._patience
