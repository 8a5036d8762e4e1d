"""Find the smallest number of triangles that reaches a quality."""

from collections.abc import Callable
from dataclasses import dataclass

from stages.mesh import Mesh
from warp_kernels.errors import OptionError

FIRST_GUESS = 500
"""Triangles of the first trial."""
FALL = 0.4
"""The rmse falls about as the number of triangles to the power of minus this."""
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
        The smallest mesh found whose rmse is at most the one wanted; a mesh with 1 % fewer
        triangles misses it.

    Raises:
        OptionError: If as many triangles as the picture bears do not reach it.
    """
    most = max(least, pixels // PIXELS_PER_TRIANGLE)
    count = min(max(FIRST_GUESS, least), most)
    missed = least - 1
    best: Trial | None = None
    for _ in range(MOST_TRIALS):
        trial = attempt(count)
        if trial.rmse > rmse:
            if count >= most:
                raise _out_of_reach(rmse, trial, count)
            missed = max(missed, count)
        else:
            best = trial if best is None or count < best.mesh.triangle_count else best
        reached = most if best is None else min(best.mesh.triangle_count, most)
        if best is not None and reached - missed <= max(1, PRECISION * reached):
            break
        # aim a little above the number that the power law says, which is then likely the answer
        aim = count * (max(trial.rmse, 1e-9) / rmse) ** (1 / FALL) * (1 + PRECISION / 3)
        count = _between(aim, missed, reached if best is not None else most + 1)
    if best is None:
        raise _out_of_reach(rmse, trial, count)
    return best.mesh


def _between(aim: float, missed: int, reached: int) -> int:
    """The number nearest to an aim that is more than what misses and less than what reaches."""
    return int(min(max(round(min(aim, reached)), missed + 1), reached - 1))


def _out_of_reach(rmse: float, trial: Trial, count: int) -> OptionError:
    return OptionError(
        f"--quality {rmse:g}: out of reach, {count} triangles still have an rmse of "
        f"{trial.rmse:.3g}; ask for {trial.rmse * 1.02:.2g} or more, or for --color linear"
    )
