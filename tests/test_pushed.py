"""Pushing items into an iterator that pulls."""

import gc
import threading
import time
from collections.abc import Iterator

import pytest

from pipeline.library.pushed import Pushed


def pairs(items: Iterator[int]) -> Iterator[tuple[int, int | None]]:
    """Items with the next one, which has to be known; a third is given three times."""
    before = None
    for item in items:
        if before is not None:
            yield from [(before, item)] * (3 if before == 3 else 1)
        before = item
    yield (-1 if before is None else before), None


def failing(items: Iterator[int]) -> Iterator[int]:
    """Fails at the second item."""
    for item in items:
        if item == 2:
            raise ValueError("no twos")
        yield item


def test_gives_what_is_ready() -> None:
    """However far it looks ahead, and however much it makes of an item."""
    pushed = Pushed(pairs)
    assert [pushed.push(n) for n in (1, 2, 3, 4)] == [[], [(1, 2)], [(2, 3)], [(3, 4)] * 3]
    assert pushed.finish() == [(4, None)]
    assert Pushed(pairs).finish() == [(-1, None)]


def test_error_comes_out_where_it_arises() -> None:
    """As it was raised; then the thread is gone."""
    pushed = Pushed(failing)
    assert pushed.push(1) == [1]
    with pytest.raises(ValueError, match="no twos"):
        pushed.push(2)
    pushed.close()


@pytest.mark.parametrize("how", ["close", "forget", "forget new"])
def test_thread_ends(how: str) -> None:
    """When it is closed, or nobody knows it any more."""
    before = set(threading.enumerate())  # those of earlier tests may still end
    pushed: Pushed[int, object] | None = Pushed(pairs)
    assert len(set(threading.enumerate()) - before) == 1
    if how != "forget new":
        pushed.push(1)
    if how == "close":
        pushed.close()
    pushed = None
    gc.collect()
    deadline = time.monotonic() + 10
    while set(threading.enumerate()) - before and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not set(threading.enumerate()) - before
