"""What a run comes to, counted while it goes on."""

from collections.abc import Iterable
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from pipeline.progress import Progress


@dataclass(frozen=True)
class Animated:
    """What a finished job came to."""

    frames: int
    """Frames written."""
    seconds: float
    """Wall time, from the first frame's decoding to the finished file [s]."""
    mean_rmse: float
    """Mean over the frames of the root mean square error [code values]."""
    warnings: tuple[str, ...]
    """Damage that was met, one sentence each."""
    notes: tuple[str, ...]
    """Choices that were made, one sentence each."""


class Tally:
    """Counts finished frames and tells of them."""

    def __init__(self, progress: Progress, total: int | None) -> None:
        self._progress = progress
        self._total = total
        self._errors: list[float] = []
        self._told = 0

    def add(self, triangles: int, rmse: float, *, is_told: bool = True) -> None:
        """Count a frame; what an earlier run told of is not told again."""
        self._errors.append(rmse)
        if is_told:
            self._told += 1
            self._progress.frame(len(self._errors), self._total, triangles, rmse)

    def result(self, begun: float, warnings: Iterable[str], notes: Iterable[str]) -> Animated:
        """What the job came to."""
        return Animated(
            frames=self._told,
            seconds=perf_counter() - begun,
            mean_rmse=float(np.mean(self._errors)),
            warnings=tuple(warnings),
            notes=tuple(notes),
        )
