"""How coherently an output follows its source: pictures of a few frames at a time."""

import os
from collections import deque
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from pipeline.compare.pairs import Matched
from stages.metrics.motion import SourceMotion
from stages.metrics.motion_difference import motion_difference
from stages.metrics.warp_error import warp_error

_Pictures = tuple[np.ndarray, np.ndarray]

LAGS = (1, 4)
"""How many frames apart the pictures are that are compared."""


@dataclass(frozen=True)
class Coherence:
    """What a frame has in common with earlier ones of its shot; None where there is no such one."""

    warp_errors: Mapping[int, float | None]
    """E_warp by lag, colours in [0, 1]."""
    source_warp_errors: Mapping[int, float | None]
    """The same of the source itself: what the estimate of motion misses, noise and light."""
    motion_difference: float | None
    """tOF [px]."""

    def as_dict(self) -> dict[str, float | None]:
        """Plain values for JSON."""
        errors = {f"E_warp_{lag}": value for lag, value in self.warp_errors.items()}
        own = {f"source_E_warp_{lag}": value for lag, value in self.source_warp_errors.items()}
        return {**errors, **own, "tOF": self.motion_difference}


class CoherenceMeter:
    """Compares every frame with earlier ones; keeps as many as the longest lag."""

    def __init__(self) -> None:
        self._earlier: deque[tuple[Matched, int]] = deque(maxlen=max(LAGS))
        self.motion: SourceMotion | None = None
        """Motion of the source from the frame before to the last one added, if of one shot."""

    def add(self, pair: Matched, shot: int) -> Coherence:
        """Compare the next frame.

        Args:
            pair: The frame and what became of it.
            shot: Number of the frame with which its shot begins.
        """
        lags = {lag: before for lag in LAGS if (before := self._before(lag, shot)) is not None}
        # OpenCV works without the interpreter's lock.
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            compared = {lag: pool.submit(_compared, lags[lag], pair) for lag in lags}
            difference = pool.submit(motion_difference, *_steps(lags[1], pair)) if lags else None
        found = {lag: future.result() for lag, future in compared.items()}
        self.motion = found[1].motion if found else None
        self._earlier.append((pair, shot))
        return Coherence(
            {lag: found[lag].error if lag in found else None for lag in LAGS},
            {lag: found[lag].own if lag in found else None for lag in LAGS},
            None if difference is None else difference.result(),
        )

    def _before(self, lag: int, shot: int) -> Matched | None:
        """The frame of the same shot so many frames ago."""
        if len(self._earlier) < lag:
            return None
        pair, its_shot = self._earlier[-lag]
        return pair if its_shot == shot else None


def mean_coherence(frames: list[Coherence]) -> Coherence:
    """Means over the frames that have a value."""
    return Coherence(
        {lag: mean_of(frame.warp_errors[lag] for frame in frames) for lag in LAGS},
        {lag: mean_of(frame.source_warp_errors[lag] for frame in frames) for lag in LAGS},
        mean_of(frame.motion_difference for frame in frames),
    )


def mean_of(values: Iterable[float | None]) -> float | None:
    """Mean of the values that there are, or None."""
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if known else None


@dataclass(frozen=True, eq=False)
class _Compared:
    """Two frames of a shot."""

    motion: SourceMotion
    """How the source moves from one to the other."""
    error: float | None
    """E_warp of the output."""
    own: float | None
    """E_warp of the source."""


def _compared(before: Matched, after: Matched) -> _Compared:
    source, output = _steps(before, after)
    motion = SourceMotion.between(*source)
    return _Compared(motion, warp_error(*output, motion), warp_error(*source, motion))


def _steps(before: Matched, after: Matched) -> tuple[_Pictures, _Pictures]:
    """Two pictures of the source, and of the output."""
    return (before.frame.pixels, after.frame.pixels), (before.shown, after.shown)
