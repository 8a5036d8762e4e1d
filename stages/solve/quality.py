"""Find the smallest number of triangles that reaches a quality."""

from collections.abc import Callable
from dataclasses import dataclass
from math import log, sqrt

from stages.mesh import Mesh
from warp_kernels.errors import OptionError

FIRST_GUESS = 500
"""Triangles of the first trial."""
FALL = 0.4
"""The rmse falls about as the number of triangles to the power of minus this."""
LEAST_FALL = 0.05
"""Smallest power that is believed: where luck decides the rmse hardly falls at all."""
PRECISION = 0.01
"""The search ends when the number is known to this part of it: where luck decides, not number."""
MOST_TRIALS = 12
"""Trials that the search may take; about five are usual."""
PIXELS_PER_TRIANGLE = 8
"""Smaller triangles on average are hardly better than the picture itself."""


@dataclass(frozen=True, eq=False)
class Trial:
    """A mesh and how good it is."""

    mesh: Mesh
    """What was reached."""
    rmse: float
    """Root mean square error per channel [code values]."""


def smallest_that_reaches(
    rmse: float, attempt: Callable[[int], Trial], *, least: int, pixels: int
) -> Mesh:
    """Approximate a picture with as few triangles as an rmse allows.

    Args:
        rmse: What is to be reached [code values].
        attempt: Approximates the picture with a number of triangles.
        least: Fewest triangles that are allowed.
        pixels: Pixels of the picture.

    Returns:
        The smallest mesh found whose rmse is at most the one wanted. Where the rmse falls with the
        number of triangles, 1 % fewer would miss it; after `MOST_TRIALS` it is what was found.

    Raises:
        OptionError: If as many triangles as the picture bears do not reach it.
    """
    most = max(least, pixels // PIXELS_PER_TRIANGLE)
    count = min(max(FIRST_GUESS, least), most)
    missed: tuple[int, float] | None = None
    best: Trial | None = None
    for _ in range(MOST_TRIALS):
        trial = attempt(count)
        if trial.rmse > rmse:
            if count >= most:
                raise _out_of_reach(rmse, trial, count)
            if missed is None or count > missed[0]:
                missed = (count, trial.rmse)
        elif best is None or trial.mesh.triangle_count < best.mesh.triangle_count:
            best = trial
        low = least - 1 if missed is None else missed[0]
        high = most + 1 if best is None else best.mesh.triangle_count
        if best is not None and high - low <= max(1, PRECISION * high):
            break
        aim = _crossing(rmse, (count, trial.rmse), missed, best)
        # from below aim above and from above below: the next trial closes in from the other side
        aim *= 1 - 0.7 * PRECISION if trial.rmse <= rmse else 1 + 0.4 * PRECISION
        if missed is None or best is None:
            count = int(min(max(round(aim), low + 1), high - 1))
        else:
            count = _within(aim, low, high)
    if best is None:
        raise _out_of_reach(rmse, trial, count)
    return best.mesh


def _crossing(
    rmse: float, last: tuple[int, float], missed: tuple[int, float] | None, best: Trial | None
) -> float:
    """The number that should have an rmse, by a power law through what is known."""
    count, found = last
    fall = FALL
    if missed is not None and best is not None and best.rmse > 0:
        fall = log(missed[1] / best.rmse) / log(best.mesh.triangle_count / missed[0])
    return float(count * (max(found, 1e-9) / rmse) ** (1 / max(fall, LEAST_FALL)))


def _within(aim: float, low: int, high: int) -> int:
    """The aim, or the middle of what is left where it would cut off too little of much."""
    if high - low > 16 * PRECISION * high:
        margin = (high - low) / 8
        if not low + margin <= aim <= high - margin:
            aim = sqrt(max(low, 1) * high)
    return int(min(max(round(aim), low + 1), high - 1))


def _out_of_reach(rmse: float, trial: Trial, count: int) -> OptionError:
    return OptionError(
        f"--quality {rmse:g}: out of reach, {count} triangles still have an rmse of "
        f"{trial.rmse:.3g}; ask for {trial.rmse * 1.02:.2g} or more"
    )
