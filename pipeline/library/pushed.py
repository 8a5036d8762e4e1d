"""An iterator over items that come one by one: turns what pulls into what is pushed."""

import weakref
from collections.abc import Callable, Iterator
from queue import SimpleQueue
from threading import Thread
from typing import Any, Generic, TypeVar

In = TypeVar("In")
Out = TypeVar("Out")

_ASKS, _END, _STOP = object(), object(), object()
"""The thread wants another item; there is none; nobody wants what it makes."""


class Pushed(Generic[In, Out]):
    """Runs an iterator in a thread of its own, which works only while a call here waits for it.

    How many items the iterator looks ahead is its own affair: a call gives what it made before it
    asked for more. Once one of its errors has come out, or a call was interrupted, it is over.

    Args:
        run: Makes the iterator; must hold no reference to this object or to its owner.
    """

    def __init__(self, run: Callable[[Iterator[In]], Iterator[Out]]) -> None:
        self._items: SimpleQueue[Any] = SimpleQueue()
        self._made: SimpleQueue[Any] = SimpleQueue()
        self._thread = Thread(
            target=_work, args=(run, self._items, self._made), daemon=True, name="trimotion-pushed"
        )
        self._thread.start()
        weakref.finalize(self, self._items.put, _STOP)  # forgotten ones end, too

    def push(self, item: In) -> list[Out]:
        """Hand an item over; gives what is ready."""
        self._items.put(item)
        return self._ready()

    def finish(self) -> list[Out]:
        """Say that there are no more items; gives the rest."""
        self._items.put(_END)
        rest = self._ready()
        self._thread.join()
        return rest

    def close(self) -> None:
        """End the thread; what it works on is finished first."""
        self._items.put(_STOP)
        self._thread.join()

    def _ready(self) -> list[Out]:
        """What is made until another item is asked for, or all is done."""
        ready: list[Out] = []
        while True:
            message, value = self._made.get()
            if message is None:
                ready.append(value)
            elif message is _ASKS:
                return ready
            elif value is not None:
                raise value
            else:
                return ready


def _work(
    run: Callable[[Iterator[Any]], Iterator[Any]], items: SimpleQueue[Any], made: SimpleQueue[Any]
) -> None:
    """What the thread does."""
    error: BaseException | None = None
    try:
        for result in run(_handed(items, made)):
            made.put((None, result))
    except BaseException as caught:  # raised again by the other side, whatever it is
        error = caught
    made.put((_END, error))


def _handed(items: SimpleQueue[Any], made: SimpleQueue[Any]) -> Iterator[Any]:
    """The items; asks for each but the first, for which a call waits already."""
    while True:
        item = items.get()
        if item is _STOP:
            raise GeneratorExit
        if item is _END:
            return
        yield item
        made.put((_ASKS, None))
