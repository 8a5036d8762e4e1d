"""How fast a window may speak."""

from collections.abc import Callable
from time import monotonic

RATE = 120.0
"""Messages a second that a window may go on sending: a hand gives no more than 60 places."""
BURST = 360.0
"""Messages that it may send at once."""


class Pace:
    """A bucket that fills with time and empties with messages.

    Args:
        rate: Messages a second.
        burst: Messages at once.
        clock: Tells the time [s].
    """

    def __init__(
        self, rate: float = RATE, burst: float = BURST, clock: Callable[[], float] = monotonic
    ) -> None:
        self._rate, self._burst, self._clock = rate, burst, clock
        self._left, self._at = burst, clock()

    def is_kept(self) -> bool:
        """Count a message; whether it comes in time."""
        now = self._clock()
        self._left = min(self._burst, self._left + (now - self._at) * self._rate) - 1.0
        self._at = now
        return self._left >= 0.0
