"""What goes to and from a card: gathered, so that a round needs few copies.

A copy between host and card takes ten microseconds whatever its size, and a mesh consists of a
dozen arrays. So what is written waits in memory of the host until something is launched or read;
then all of it goes over at once, and a kernel spreads it over the arrays it is meant for. What is
read together is gathered by a kernel and comes back at once.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.device.launcher import Launcher
from warp_kernels.device.runtime import WARP
from warp_kernels.device.spread import LANES, MOST_PIECES, ROW, WORD, Table, gather, scatter
from warp_kernels.device.turn import Turn

LARGE = 1 << 20
"""Arrays of more bytes are copied alone: another copy on the card would cost more."""
TO_CARD, TO_HOST, LAUNCHES, WAITS = "copies to the card", "copies to the host", "launches", "waits"
"""What is counted."""


@dataclass(frozen=True, eq=False)
class ArrayRows:
    """The beginning of an array of a device."""

    array: wp.array
    count: int
    column: int | None = None
    """Read this one of two-dimensional numbers alone; None for all there is."""


class Staging:
    """The way to and from a card.

    All methods are called by who holds `turn`, and none by who holds the lock of Warp: some wait,
    and other threads launch meanwhile.

    Args:
        device: Warp's device.
        launcher: Launches and copies there, on a stream of its own.
        traffic: Counts copies, launches and waits.
        turn: Who uses it.
    """

    def __init__(self, device: Any, launcher: Launcher, traffic: Counter[str], turn: Turn) -> None:
        self._device = device
        self._launcher = launcher
        self._traffic = traffic
        self.turn = turn
        """Held by whoever uses it: threads that share it take turns."""
        self._waiting: dict[int, tuple[wp.array, np.ndarray]] = {}
        self._sent: Any = None
        self._reserve(1 << 16)

    def write(self, array: wp.array, values: np.ndarray) -> None:
        """Copy host values into the beginning of an array, not later than the next launch.

        Args:
            array: Of the device.
            values: Rows of it, in any type that can be cast to its own; they are copied at once.
        """
        kind, shape = _host_row(array)
        kept = np.empty((len(values), *shape), kind)
        kept[...] = values
        before = self._waiting.get(array.ptr)
        if before is not None and before[1].nbytes > kept.nbytes:
            self.flush()  # a part of what is already waiting is overwritten
        self._waiting.pop(array.ptr, None)
        if kept.nbytes > LARGE or _row_bytes(kept) % WORD:
            self._send_alone(array, kept)
        elif kept.nbytes:
            self._waiting[array.ptr] = (array, kept)

    def flush(self) -> None:
        """Send what waits."""
        if not self._waiting:
            return
        waiting = list(self._waiting.values())
        self._waiting.clear()
        begins = [0, *accumulate(kept.nbytes for _, kept in waiting)]
        self._reserve(begins[-1])
        self._wait_for_sent()
        for begin, (_, kept) in zip(begins, waiting, strict=False):
            self._seen[begin : begin + kept.nbytes] = kept.reshape(-1).view(np.uint8)
        self._copy(self._on_card, self._pinned, begins[-1], TO_CARD)
        rows = [
            (array.ptr, begin // WORD, 1, kept.nbytes // WORD, 0)
            for begin, (array, kept) in zip(begins, waiting, strict=False)
        ]
        self._move(self._scatter, 1, rows)
        self._mark_sent()

    def read(self, wanted: Sequence[ArrayRows]) -> list[np.ndarray]:
        """Copy rows of arrays to the host, in one copy if they are many.

        Args:
            wanted: What to read.
        """
        self.flush()
        sizes = [_bytes_of(rows) for rows in wanted]
        if len(wanted) == 1 and wanted[0].column is None:
            self._reserve(sizes[0])
            self._copy(self._pinned, _as_bytes(wanted[0].array, sizes[0]), sizes[0], TO_HOST)
        else:
            begins = [0, *accumulate(sizes)]
            self._reserve(begins[-1])
            places = [_place_of(r, begin) for r, begin in zip(wanted, begins, strict=False)]
            self._move(self._gather, 0, [place for place in places if place[2] * place[3]])
            self._copy(self._pinned, self._on_card, begins[-1], TO_HOST)
        self.wait()
        found, begin = [], 0
        for rows, size in zip(wanted, sizes, strict=True):
            kind, shape = _host_row(rows.array)
            shape = shape if rows.column is None else shape[1:]
            raw = self._seen[begin : begin + size]
            found.append(raw.view(kind).reshape(rows.count, *shape).copy())
            begin += size
        return found

    def wait(self) -> None:
        """Wait until everything launched so far is done."""
        self._traffic[WAITS] += 1
        self._launcher.wait(self._launcher.mark())
        self._sent = None

    def _send_alone(self, array: wp.array, kept: np.ndarray) -> None:
        """Copy one array, past what waits."""
        self._reserve(kept.nbytes)
        self._wait_for_sent()
        self._seen[: kept.nbytes] = kept.reshape(-1).view(np.uint8)
        self._copy(_as_bytes(array, kept.nbytes), self._pinned, kept.nbytes, TO_CARD)
        self._mark_sent()

    def _copy(self, target: wp.array, source: wp.array, size: int, counted: str) -> None:
        """Copy bytes, without waiting where one of the two is pinned."""
        if size:
            self._traffic[counted] += 1
            self._launcher.copy(target, source, size)

    def _move(self, launch: Any, argument: int, rows: Sequence[tuple[int, ...]]) -> None:
        """Launch a kernel that spreads or gathers; one of its arguments is the table."""
        for first in range(0, len(rows), MOST_PIECES):
            some = rows[first : first + MOST_PIECES]
            numbers = [number for row in some for number in row]
            launch.set_param_at_index(
                argument, Table(numbers + [0] * (MOST_PIECES * ROW - len(numbers)))
            )
            launch.set_dim(len(some) * LANES)
            self._launcher.launch(launch)
            self._traffic[LAUNCHES] += 1

    def _reserve(self, size: int) -> None:
        """Have room for so many bytes on both sides."""
        if hasattr(self, "_pinned") and size <= len(self._seen):
            return
        self.wait()
        room = size * 3 // 2 // WORD * WORD + WORD
        is_card = bool(self._device.is_cuda)
        with WARP, self._launcher.on_stream():
            self._pinned = wp.empty(room, dtype=wp.uint8, device="cpu", pinned=is_card)
            self._on_card = wp.empty(room, dtype=wp.uint8, device=self._device)
            self._seen: np.ndarray = self._pinned.numpy()
            words = wp.array(
                ptr=self._on_card.ptr, shape=room // WORD, dtype=int, device=self._device
            )
        self._scatter = self._launcher.record(scatter, [words, Table()])
        self._gather = self._launcher.record(gather, [Table(), words])

    def _mark_sent(self) -> None:
        """Remember when the pinned memory may be used again."""
        self._sent = self._launcher.mark()

    def _wait_for_sent(self) -> None:
        """Wait until the pinned memory may be used again."""
        self._launcher.wait(self._sent)
        self._sent = None


def _host_row(array: wp.array) -> tuple[np.dtype[Any], tuple[int, ...]]:
    """Type of an array's numbers on the host, and shape of a row of it."""
    if hasattr(array.dtype, "numpy_dtype"):
        return np.dtype(array.dtype.numpy_dtype()), tuple(array.shape[1:])
    on_card = bool(array.device.is_cuda)
    told = array.__cuda_array_interface__ if on_card else array.__array_interface__
    return np.dtype(told["typestr"]), tuple(told["shape"][1:])


def _row_bytes(rows: np.ndarray) -> int:
    """Bytes of a row."""
    return rows.nbytes // max(1, len(rows))


def _bytes_of(rows: ArrayRows) -> int:
    """Bytes that are read of rows."""
    kind, shape = _host_row(rows.array)
    shape = shape if rows.column is None else shape[1:]
    return rows.count * int(kind.itemsize * np.prod(shape, dtype=int))


def _place_of(rows: ArrayRows, begin: int) -> tuple[int, ...]:
    """A row of the table for a kernel that gathers.

    Raises:
        ValueError: If the rows are no words.
    """
    size = _bytes_of(rows)
    if size % WORD:
        raise ValueError(f"rows of {size} bytes cannot be read together with others")
    if rows.column is None:
        return rows.array.ptr, begin // WORD, 1, size // WORD, 0
    width, stride = size // max(1, rows.count), rows.array.strides[0]
    first = rows.array.ptr + rows.column * width
    return first, begin // WORD, rows.count, width // WORD, stride // WORD


def _as_bytes(array: wp.array, size: int) -> wp.array:
    """The beginning of an array as bytes."""
    with WARP:
        return wp.array(ptr=array.ptr, shape=(size,), dtype=wp.uint8, device=array.device)
