"""Generators that run ahead and a consumer that runs behind: the only threads of a job."""

from collections.abc import Callable, Generator, Iterable
from contextlib import suppress
from dataclasses import dataclass
from queue import Empty, Full, Queue
from threading import Event, Thread
from types import TracebackType
from typing import Any, Generic, TypeVar

Item = TypeVar("Item")

_PATIENCE = 0.1
"""How long a blocked thread waits before it looks whether the job has ended [s]."""


@dataclass(frozen=True)
class _End:
    """Last thing in a queue: the source is exhausted, or failed."""

    error: BaseException | None


def ahead(items: Iterable[Item], depth: int) -> Generator[Item, None, None]:
    """Run an iterable in a thread of its own, up to `depth` items ahead.

    An exception of the iterable is raised here, in its place. Closing this generator ends the
    thread.

    Args:
        items: What to iterate over; only the thread touches it from now on.
        depth: Items that may wait.
    """
    queue: Queue[Any] = Queue(maxsize=depth)
    stopped = Event()

    def feed() -> None:
        """Fill the queue until the source or the consumer ends."""
        error: BaseException | None = None
        try:
            for item in items:
                if not _put(queue, item, stopped):
                    return
        except BaseException as caught:  # raised again by the consumer, whatever it is
            error = caught
        _put(queue, _End(error), stopped)

    thread = Thread(target=feed, name="trimotion-ahead", daemon=True)
    thread.start()
    try:
        while True:
            item = queue.get()
            if isinstance(item, _End):
                if item.error is not None:
                    raise item.error
                return
            yield item
    finally:
        stopped.set()
        with suppress(Empty):
            while True:
                queue.get_nowait()
        thread.join()


class Behind(Generic[Item]):
    """Runs a function over items in a thread of its own, in order; a context manager.

    Leaving the block waits for what is left; leaving it by an exception drops it. A failure of
    the function is raised by the next `put` or at the end of the block.

    Args:
        consume: What to do with an item.
        depth: Items that may wait.
    """

    def __init__(self, consume: Callable[[Item], None], depth: int) -> None:
        self._consume = consume
        self._queue: Queue[Any] = Queue(maxsize=depth)
        self._stopped = Event()
        self._error: BaseException | None = None
        self._thread = Thread(target=self._work, name="trimotion-behind", daemon=True)
        self._thread.start()

    def put(self, item: Item) -> None:
        """Hand over an item; waits while the queue is full."""
        if not _put(self._queue, item, self._stopped) and self._error is not None:
            raise self._error

    def _work(self) -> None:
        while True:
            item = self._queue.get()
            if isinstance(item, _End):
                return
            try:
                self._consume(item)
            except BaseException as error:  # raised again by the producer, whatever it is
                self._error = error
                self._stopped.set()
                return

    def __enter__(self) -> "Behind[Item]":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is not None:
            with suppress(Empty):
                while True:
                    self._queue.get_nowait()
        _put(self._queue, _End(None), self._stopped)
        self._thread.join()
        if error is None and self._error is not None:
            raise self._error


def _put(queue: Queue[Any], item: Any, stopped: Event) -> bool:
    """Put an item unless the other side has stopped; whether it was put."""
    while not stopped.is_set():
        try:
            queue.put(item, timeout=_PATIENCE)
            return True
        except Full:
            continue
    return False
