"""How long each stage of a run works: decoding, solving, drawing, each in a thread of its own."""

import threading
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from contextlib import contextmanager
from time import perf_counter
from typing import TypeVar

Item = TypeVar("Item")

WAITING = "waiting for "
"""How stages begin in which a thread does nothing."""


class StageTimes:
    """Adds up what stages take; what one calls another for is the other's, and not its own.

    Stages of several threads run side by side, so together they may take longer than the run.
    """

    def __init__(self, clock: Callable[[], float] = perf_counter) -> None:
        """Begin to count.

        Args:
            clock: Gives the time [s].
        """
        self._clock = clock
        self._lock = threading.Lock()
        self._seconds: dict[str, float] = {}
        self._own = threading.local()

    @property
    def seconds(self) -> dict[str, float]:
        """What each stage took so far [s], by name, in the order in which they were first left."""
        with self._lock:
            return dict(self._seconds)

    @contextmanager
    def spent(self, name: str) -> Iterator[None]:
        """Count the time of a block.

        Args:
            name: The stage.
        """
        begun = self._clock()
        outer = getattr(self._own, "within", 0.0)
        self._own.within = 0.0
        try:
            yield
        finally:
            whole = self._clock() - begun
            with self._lock:
                taken = whole - self._own.within
                self._seconds[name] = self._seconds.get(name, 0.0) + taken
            self._own.within = outer + whole

    def over(self, name: str, items: Iterable[Item]) -> Generator[Item, None, None]:
        """Give what an iterable gives, and count the time that it takes for that.

        Args:
            name: The stage.
            items: What to iterate over; closed with this generator if it can be.
        """
        steps = iter(items)
        try:
            while True:
                with self.spent(name):
                    try:
                        item = next(steps)
                    except StopIteration:
                        return
                yield item
        finally:
            close = getattr(steps, "close", None)
            if close is not None:
                close()


def added(every: Iterable[Mapping[str, float]]) -> dict[str, float]:
    """Times of several runs together, by stage.

    Args:
        every: Of each of them [s].
    """
    found: dict[str, float] = {}
    for one in every:
        for name, seconds in one.items():
            found[name] = found.get(name, 0.0) + seconds
    return found
