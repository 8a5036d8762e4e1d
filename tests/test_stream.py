"""Threads that run ahead and behind: order, errors, ends and bounds."""

import threading
import time
from collections.abc import Iterator

import pytest

from pipeline.loop.threads import Behind, ahead

NAMES = {"trimotion-ahead", "trimotion-behind"}


def workers() -> list[str]:
    """Threads of this module's subject that live."""
    return [thread.name for thread in threading.enumerate() if thread.name in NAMES]


@pytest.fixture(autouse=True)
def _no_thread_stays() -> Iterator[None]:
    """Every test ends with the threads it started."""
    yield
    assert not workers()


class Source:
    """Counts what is taken from it and whether it was closed."""

    def __init__(self, count: int, fail_at: int | None = None) -> None:
        self.count, self.fail_at = count, fail_at
        self.made, self.closed = 0, False

    def __iter__(self) -> Iterator[int]:
        """Give 0, 1, ... until the failure or the end."""
        try:
            for number in range(self.count):
                if number == self.fail_at:
                    raise OSError("planted")
                self.made += 1
                yield number
        finally:
            self.closed = True


def until(condition, seconds: float = 5.0) -> bool:
    """Wait for a condition to hold."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.002)
    return bool(condition())


def put_all(behind: Behind[int], count: int, error: Exception | None = None) -> None:
    """Put 0, 1, ... inside the block, then raise an error in it, if there is one."""
    with behind as consumer:
        for item in range(count):
            consumer.put(item)
        if error is not None:
            raise error


@pytest.mark.parametrize("count", [0, 1, 50])
def test_ahead_keeps_everything_in_order(count: int) -> None:
    """All items come, in order, however fast the consumer is."""
    assert list(ahead(Source(count), depth=3)) == list(range(count))


def test_ahead_runs_ahead_within_its_bound() -> None:
    """The source is asked while the consumer sleeps, for what fits and one more."""
    source = Source(100)
    items = ahead(source, depth=4)
    assert next(items) == 0
    assert until(lambda: source.made >= 6)
    time.sleep(0.05)
    assert source.made == 6  # one taken, four waiting, one in hand
    items.close()


def test_error_of_the_source_comes_in_its_place() -> None:
    """What was made before the failure is delivered first."""
    items = ahead(Source(10, fail_at=3), depth=2)
    assert [next(items) for _ in range(3)] == [0, 1, 2]
    with pytest.raises(OSError, match="planted"):
        next(items)


def test_closing_early_ends_thread_and_source() -> None:
    """A consumer that stops leaves no thread and no open source behind."""
    source = Source(1000)
    items = ahead(source, depth=2)
    assert next(items) == 0
    items.close()
    assert not workers()
    assert source.closed
    assert source.made < 10


def test_closing_before_the_first_item() -> None:
    """A generator that was never asked starts nothing."""
    source = Source(3)
    ahead(source, depth=2).close()
    assert source.made == 0


def test_behind_takes_everything_in_order() -> None:
    """Leaving the block waits for what is left."""
    taken: list[int] = []

    def slowly(item: int) -> None:
        time.sleep(0.001)
        taken.append(item)

    with Behind(slowly, depth=3) as consumer:
        for item in range(40):
            consumer.put(item)
    assert taken == list(range(40))


def test_behind_is_bounded() -> None:
    """`put` waits once the queue is full: one item in hand, `depth` waiting."""
    gate, given = threading.Event(), []

    def produce() -> None:
        with Behind(lambda _: gate.wait(), depth=3) as consumer:
            for item in range(10):
                consumer.put(item)
                given.append(item)

    producer = threading.Thread(target=produce)
    producer.start()
    assert until(lambda: len(given) >= 4)
    time.sleep(0.05)
    assert len(given) == 4
    gate.set()
    producer.join(5)
    assert len(given) == 10


def test_error_of_the_consumer_reaches_the_producer() -> None:
    """A later `put` raises it, however many there are, and the producer is not kept waiting."""

    def fail(_: int) -> None:
        raise OSError("planted")

    with pytest.raises(OSError, match="planted"):
        put_all(Behind(fail, depth=1), 10**9)


def test_error_on_the_last_item_is_raised_at_the_end() -> None:
    """No failure is lost when there is nothing left to put."""

    def fail_late(item: int) -> None:
        time.sleep(0.01)
        if item == 2:
            raise OSError("planted")

    with pytest.raises(OSError, match="planted"):
        put_all(Behind(fail_late, depth=5), 3)


def test_error_in_the_block_drops_what_waits() -> None:
    """The block's own error comes out; items that wait are not consumed any more."""
    taken: list[int] = []

    def slowly(item: int) -> None:
        time.sleep(0.02)
        taken.append(item)

    with pytest.raises(KeyError, match="planted"):
        put_all(Behind(slowly, depth=50), 50, KeyError("planted"))
    assert len(taken) < 5
