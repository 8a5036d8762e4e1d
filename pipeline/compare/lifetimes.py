"""How many frames triangles live."""

import numpy as np


class Lifetimes:
    """Counts the frames of every triangle; keeps those that live and a histogram of the others."""

    def __init__(self) -> None:
        self._ids = np.empty(0, dtype=np.int64)
        self._ages = np.empty(0, dtype=np.int64)
        self._ended = np.zeros(1, dtype=np.int64)

    def add(self, ids: np.ndarray, *, goes_on: bool) -> None:
        """Count the next frame.

        Args:
            ids: Persistent numbers of its triangles, shape [T].
            goes_on: Whether they are those of the frame before, as far as they lived then.
        """
        ids = np.sort(ids)
        if not goes_on:
            self._ended = self._histogram(self._ages)
            self._ids, self._ages = ids, np.ones(len(ids), dtype=np.int64)
            return
        lives = np.isin(self._ids, ids, assume_unique=True)
        self._ended = self._histogram(self._ages[~lives])
        ages = np.ones(len(ids), dtype=np.int64)
        ages[np.searchsorted(ids, self._ids[lives])] += self._ages[lives]
        self._ids, self._ages = ids, ages

    def median(self) -> float | None:
        """Median over all triangles, those that live included [frames]; None before any."""
        upto = np.cumsum(self._histogram(self._ages))
        count = int(upto[-1])
        if not count:
            return None
        middle = np.searchsorted(upto, [(count - 1) // 2, count // 2], side="right")
        return float(middle.mean())

    def _histogram(self, ages: np.ndarray) -> np.ndarray:
        """Ended lives and some more, by their length."""
        counts = np.bincount(ages, minlength=len(self._ended))
        counts[: len(self._ended)] += self._ended
        return counts
