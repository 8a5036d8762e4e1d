"""When an optimisation has arrived: the rule that all of them share."""

LEAST_SAVING = 2e-4
"""Rounds that save less than this part of the energy count as idle."""
PATIENCE = 3
"""Idle rounds in a row after which nothing more is expected: one alone may be a step too far."""


class Convergence:
    """Watches the energy of a mesh whose number of triangles does not change any more."""

    def __init__(self) -> None:
        self._best = float("inf")
        self._idle = 0

    def is_reached(self, energy: float) -> bool:
        """Take the energy after a round [code value^2 px]; whether to stop."""
        if energy < (1.0 - LEAST_SAVING) * self._best:
            self._best, self._idle = energy, 0
        else:
            self._idle += 1
        return self._idle >= PATIENCE
