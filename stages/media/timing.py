"""Presentation times that strictly increase, whatever the file says."""

from fractions import Fraction


class TimeRepair:
    """Turns the times of decoded frames into strictly increasing ones.

    Times that already increase pass unchanged. A single frame that lies behind its predecessor
    is moved just after it. From the second such frame in a row on, the clock is taken to have
    restarted, and all that follows is shifted so that time goes on.
    """

    def __init__(self, step: int) -> None:
        """Start a clip.

        Args:
            step: Usual distance of two frames [time base units], at least 1; it fills gaps.
        """
        self.repaired = 0
        """Number of frames whose time was changed or invented."""
        self._step = max(1, step)
        self._last: int | None = None
        self._offset = 0
        self._backward = False

    def __call__(self, pts: int | None, duration: int | None) -> int:
        """Time of the next frame.

        Args:
            pts: Time that the file gives [time base units], or None.
            duration: How long the file shows the frame [time base units]; None or 0 if unknown.

        Returns:
            A time later than all earlier ones [time base units].
        """
        step = duration if duration and 0 < duration < 100 * self._step else self._step
        time = self._next(pts)
        self.repaired += pts is None or time != pts
        self._last = time
        self._step = step
        return time

    def _next(self, pts: int | None) -> int:
        if self._last is None:
            return 0 if pts is None else pts
        follow = self._last + self._step
        if pts is None:
            return follow
        if pts > self._last:
            self._offset, self._backward = 0, False
            return pts
        if pts + self._offset > self._last:
            return pts + self._offset
        if self._backward:
            self._offset = follow - pts
        self._backward = True
        return follow


def usual_step(rate: Fraction | None, time_base: Fraction) -> int:
    """Distance of two frames at a frame rate.

    Args:
        rate: Frames per second, or None; then 25 is taken.
        time_base: Seconds per unit.

    Returns:
        The distance, rounded [time base units], at least 1.
    """
    return max(1, round(1 / ((rate or Fraction(25)) * time_base)))
