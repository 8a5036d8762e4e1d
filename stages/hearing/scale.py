"""A scale whose marks lie unevenly, such as beats in time, and goes on beyond its ends."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Scale:
    """Places on a scale and the values at them; piecewise linear, and so are both ends.

    Raises:
        ValueError: If there are fewer than two marks, or they are not ascending.
    """

    marks: np.ndarray
    """Where the places `first`, `first + 1`, ... lie, [N] float64, ascending, at least two."""
    first: float
    """Number of the first place."""
    near: int
    """Marks at an end whose mean distance goes on beyond it."""

    def __post_init__(self) -> None:
        if len(self.marks) < 2 or not (np.diff(self.marks) > 0).all():
            raise ValueError("a scale needs two marks at least, and ascending ones")

    def place_of(self, mark: float | np.ndarray) -> float | np.ndarray:
        """The place at a mark, a number or an array.

        Args:
            mark: In the unit of the marks.
        """
        before, after, numbers = self._steps()
        given = np.asarray(mark, dtype=float)
        inside = np.interp(given, self.marks, numbers)
        start, end = self.marks[0], self.marks[-1]
        inside = np.where(given < start, numbers[0] + (given - start) / before, inside)
        inside = np.where(given > end, numbers[-1] + (given - end) / after, inside)
        return inside if np.ndim(mark) else float(inside)

    def mark_of(self, place: float | np.ndarray) -> float | np.ndarray:
        """The mark of a place, a number or an array.

        Args:
            place: May lie between two, and beyond the ends.
        """
        before, after, numbers = self._steps()
        given = np.asarray(place, dtype=float)
        inside = np.interp(given, numbers, self.marks)
        start, end = numbers[0], numbers[-1]
        inside = np.where(given < start, self.marks[0] + (given - start) * before, inside)
        inside = np.where(given > end, self.marks[-1] + (given - end) * after, inside)
        return inside if np.ndim(place) else float(inside)

    def _steps(self) -> tuple[float, float, np.ndarray]:
        """Distance of marks before the first and after the last one, and the places' numbers."""
        count = min(self.near, len(self.marks) - 1)
        before = (self.marks[count] - self.marks[0]) / count
        after = (self.marks[-1] - self.marks[-1 - count]) / count
        return float(before), float(after), self.first + np.arange(len(self.marks))


def evenly_on(start: float, step: float, first: float = 0.0) -> Scale:
    """A scale that is even everywhere.

    Args:
        start: The mark of the first place.
        step: From one mark to the next.
        first: Number of the first place.
    """
    return Scale(np.array([start, start + step]), first, 1)
