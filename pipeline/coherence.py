"""How coherently an output follows its source: pictures of a few frames at a time."""

from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from pipeline.matched import Matched
from stages.metrics import Motion, motion_difference, warp_error

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
        self.motion: Motion | None = None
        """Motion of the source from the frame before to the last one added, if of one shot."""

    def add(self, pair: Matched, shot: int) -> Coherence:
        """Compare the next frame.

        Args:
            pair: The frame and what became of it.
            shot: Number of the frame with which its shot begins.
        """
        errors: dict[int, float | None] = {}
        own: dict[int, float | None] = {}
        self.motion = None
        for lag in LAGS:
            before = self._before(lag, shot)
            errors[lag] = own[lag] = None
            if before is not None:
                motion = Motion.between(before.frame.pixels, pair.frame.pixels)
                errors[lag] = warp_error(before.shown, pair.shown, motion)
                own[lag] = warp_error(before.frame.pixels, pair.frame.pixels, motion)
                self.motion = motion if lag == 1 else self.motion
        difference = _motion_difference(self._before(1, shot), pair)
        self._earlier.append((pair, shot))
        return Coherence(errors, own, difference)

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


def _motion_difference(before: Matched | None, pair: Matched) -> float | None:
    if before is None:
        return None
    source = before.frame.pixels, pair.frame.pixels
    return motion_difference(source, (before.shown, pair.shown))
