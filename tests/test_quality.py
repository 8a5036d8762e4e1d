"""The search for the smallest number of triangles, on laws that stand for pictures."""

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from stages.solve.quality import PRECISION, Trial, smallest_that_reaches
from warp_kernels.errors import OptionError

PIXELS = 512 * 512
LAWS: dict[str, Callable[[int], float]] = {
    "a power": lambda n: 18.5 * (n / 700) ** -0.35,
    "a steep power": lambda n: 18.5 * (n / 700) ** -0.8,
    "steep, then flat": lambda n: float(
        np.interp(n, [2, 525, 700, 955, 9000], [80, 25, 20, 18, 9])
    ),
}


def found(law: Callable[[int], float], rmse: float, least: int = 2) -> tuple[int, list[int]]:
    """The number found, and those that were tried."""
    tried: list[int] = []

    def attempt(count: int) -> Trial:
        """Pretend to approximate a picture."""
        tried.append(count)
        return Trial(SimpleNamespace(triangle_count=count), law(count))

    mesh = smallest_that_reaches(rmse, attempt, least=least, pixels=PIXELS)
    return mesh.triangle_count, tried


@pytest.mark.parametrize("rmse", [9.5, 19.0, 30.0])
@pytest.mark.parametrize("name", LAWS)
def test_one_percent_less_would_miss(name: str, rmse: float) -> None:
    """What is found reaches the quality, and the search is short."""
    law = LAWS[name]
    count, tried = found(law, rmse)
    assert law(count) <= rmse
    assert law(int(count * (1 - 2 * PRECISION)) - 1) > rmse
    assert len(tried) <= 12
    assert len(set(tried)) == len(tried)


def test_the_fewest_allowed_are_enough() -> None:
    """A limit of area asks for more triangles than the quality does: they are not undercut."""
    count, _ = found(LAWS["a power"], 200.0, least=525)
    assert 525 <= count <= 530


def test_search_near_the_fewest_allowed_bisects() -> None:
    """The bug that kept creeping from 525 upwards and ended with 882 of 601 triangles."""
    count, tried = found(LAWS["steep, then flat"], 24.0, least=525)
    assert 560 <= count <= 570
    assert len(tried) <= 10


@pytest.mark.parametrize("seed", range(8))
def test_smallest_mesh_is_kept(seed: int) -> None:
    """A trial may come out larger than what it was asked for, and than what is known already."""
    rng = np.random.default_rng(seed)
    good: list[int] = []

    def attempt(count: int) -> Trial:
        """A layout that makes up to a tenth more triangles."""
        more = int(count * rng.uniform(1.0, 1.1))
        rmse = LAWS["a power"](more)
        if rmse <= 19.0:
            good.append(more)
        return Trial(SimpleNamespace(triangle_count=more), rmse)

    mesh = smallest_that_reaches(19.0, attempt, least=2, pixels=PIXELS)
    assert mesh.triangle_count == min(good)


def test_what_no_number_reaches_is_an_error() -> None:
    """The message says what was tried and what to ask for."""
    with pytest.raises(OptionError, match=r"--quality 0\.5: out of reach, 32768 triangles"):
        found(LAWS["a power"], 0.5)
