"""Where kernels run: a CUDA device, or the CPU with all its cores.

Launches are recorded once and captured into graphs, which Warp replays without the interpreter.
On CUDA a sequence of phases is one graph. On the CPU Warp runs a kernel on the calling thread, so
a launch is recorded as one part per core, over disjoint ranges; every thread of a team replays a
graph of its own parts, and they meet between two phases.

Every kernel's first parameter is `span`, the first element of its part and the one past its last,
in device memory: a graph outlives changes of the mesh as long as no part outgrows its launch.
"""

import os
import weakref
from collections import Counter
from collections.abc import Callable, Sequence
from copy import copy
from functools import partial
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.device.barrier import STRIDE, meet
from warp_kernels.device.card_memory import memory_problem
from warp_kernels.device.compiling.kernels import Told, tell_nobody
from warp_kernels.device.kernel_cache import settle_cache
from warp_kernels.device.launcher import Launcher, WarpLauncher
from warp_kernels.device.phase import SMALLEST_PART, Phase
from warp_kernels.device.runtime import EMULATED, WARP, find_device, unused_card
from warp_kernels.device.staging import LAUNCHES, ArrayRows, Staging
from warp_kernels.device.team import Team
from warp_kernels.device.turn import Turn
from warp_kernels.errors import TrimotionError


class Device:
    """A device and the threads that feed it; a context manager.

    Its threads end with `close`, or with the last reference to it. Arrays outlive it.

    Args:
        name: "auto" (CUDA if present), "cpu", "cuda:N", or "cuda-emulated" (for tests).
        threads: CPU threads; 0 for one per core. Results do not depend on it.
        tell: Told how many kernels are compiled, and of how many, where some are missing.

    Raises:
        OptionError: If there is no such device.
    """

    def __init__(self, name: str = "auto", threads: int = 0, tell: Told = tell_nobody) -> None:
        with WARP:
            self.notes = settle_cache()
        """Choices that were made, one sentence each."""
        emulated = name == EMULATED
        self.warp = find_device(name)
        self.name = EMULATED if emulated else str(self.warp.alias)
        self.is_cuda = emulated or bool(self.warp.is_cuda)
        if name == "auto" and not self.is_cuda:
            self.notes += unused_card()
        self.part_count = 1 if self.is_cuda else max(1, threads or os.cpu_count() or 1)
        self._begin(_emulated(self.warp) if emulated else WarpLauncher(self.warp, tell))

    def _begin(self, launcher: Launcher) -> None:
        """Have what belongs to one way to the device alone."""
        self._launcher = launcher
        if self.part_count > 1:
            self._launcher.expect([meet])
        self._taken = 0
        self.traffic: Counter[str] = Counter()
        """Copies, launches and waits so far, on a card."""
        # who waits for a card lets others launch there meanwhile
        self._turn: Any = WARP
        self._staging: Staging | None = None
        if self.is_cuda:
            self._turn = Turn(self.name)
            self._staging = self._new_staging(self._turn)
        self._is_closed = False
        self._team = self._new_team()

    def beside(self) -> "Device":
        """The device for another thread: of a card, a stream that waits for nothing of this one.

        Arrays, and launches over them, belong to the one that made them. The CPU's cores work for
        all threads together, so there it is the device itself.
        """
        if not self.is_cuda:
            return self
        other = copy(self)
        other._begin(self._launcher.beside())
        return other

    def _new_staging(self, turn: Turn) -> Staging:
        """The way to and from a card."""
        with turn:
            return Staging(self.warp, self._launcher, self.traffic, turn)

    def _new_team(self) -> Team:
        """Threads that end when nobody refers to the device any more."""
        with WARP, self._launcher.on_stream():
            flags = wp.zeros((self.part_count + 1) * STRIDE, dtype=int, device=self.warp)
            team = Team(self.part_count, self._launcher, flags)
        # at exit threads that wait are no burden, and one that works must not lose its team
        weakref.finalize(self, team.dismiss).atexit = False
        return team

    def expect(self, kernels: Sequence[Any]) -> None:
        """Name kernels that will be recorded: they are compiled together with the next that is.

        Args:
            kernels: Those that take longest to compile first.
        """
        with WARP:
            self._launcher.expect(kernels)

    @property
    def awaits_kernels(self) -> bool:
        """Whether kernels are expected that may not be compiled yet."""
        with WARP:
            return self._launcher.awaits_kernels

    def compile_expected(self) -> None:
        """Compile what is expected now, in a thread of one's own: others go on launching."""
        self._launcher.compile_expected()

    def record(
        self,
        kernel: Any,
        inputs: Sequence[Any],
        outputs: Sequence[Any],
        *,
        per_element: int = 1,
        smallest_part: int = SMALLEST_PART,
        flows_on: bool = False,
    ) -> Phase:
        """Record the launch of `kernel`, split over the threads; see `Phase`, also for its size."""
        with self._turn, WARP, self._launcher.on_stream():
            spans = [wp.zeros(1, dtype=wp.vec2i, device=self.warp) for _ in range(self.part_count)]
            parts = [self._launcher.record(kernel, [span, *inputs, *outputs]) for span in spans]
        return Phase(parts, self._span_writer(spans), per_element, smallest_part, flows_on)

    def _span_writer(self, spans: Sequence[wp.array]) -> Callable[[int, int, int], None]:
        """A function that writes a part's range; on the CPU straight into its memory."""
        # no reference to the device: the team's graphs keep phases, and would keep it for ever
        if self._staging is not None:
            return partial(_write_span, self._staging, spans)
        views = [_seen_by_host(span)[0] for span in spans]

        def write(number: int, begin: int, end: int) -> None:
            """Write the range of one part."""
            views[number][:] = (begin, end)

        return write

    def run(self, phases: Sequence[Phase], times: int = 1) -> None:
        """Run the phases one after the other, `times` times over, without the interpreter.

        Args:
            phases: What to run.
            times: How often; may be 0.

        Raises:
            RuntimeError: If the device was closed.
        """
        if times == 0:
            return
        with self._turn:
            if self._is_closed:
                raise RuntimeError(f"{self!r} was closed; make another one")
            if self._staging is not None:
                self._staging.flush()
                self.traffic[LAUNCHES] += times * len(phases)
            with WARP:
                try:
                    self._team.run(phases, times)
                except BaseException:
                    # an interrupt has left the team out of step: the next caller needs a new one
                    self._team.abandon()
                    self._team = self._new_team()
                    raise

    def empty(self, shape: Any, dtype: Any) -> wp.array:
        """A new device array; only workspaces ask for one.

        Raises:
            TrimotionError: If a card has no memory left.
        """
        with WARP, self._launcher.on_stream():
            try:
                array = wp.empty(shape, dtype=dtype, device=self.warp)
            except RuntimeError as error:  # all that Warp says of a full card
                if not self.warp.is_cuda:
                    raise
                asked = int(np.prod(shape)) * wp.types.type_size_in_bytes(dtype)
                free = int(self.warp.free_memory)
                problem = memory_problem(self.name, self._taken, asked, free)
                raise TrimotionError(problem) from error
            self._taken += array.size * wp.types.type_size_in_bytes(array.dtype)
            return array

    def clear(self, array: wp.array) -> None:
        """Fill a device array with zeros."""
        with self._turn:
            if self._staging is not None:
                self._staging.flush()
            with WARP, self._launcher.on_stream():
                array.zero_()

    def write(self, array: wp.array, values: np.ndarray) -> None:
        """Copy host values into the beginning of a device array."""
        if self._staging is None:
            _seen_by_host(array)[: len(values)] = values
            return
        with self._turn:
            self._staging.write(array, values)

    def read(self, array: wp.array, count: int) -> np.ndarray:
        """Copy the first `count` rows of a device array to the host."""
        return self.read_all([ArrayRows(array, count)])[0]

    def read_all(self, wanted: Sequence[ArrayRows]) -> list[np.ndarray]:
        """Copy the beginnings of several arrays to the host, which costs a card no more than one.

        Args:
            wanted: What to read; of several arrays, such as consist of words of 4 bytes.
        """
        if self._staging is None:
            return [_rows_seen(rows).copy() for rows in wanted]
        with self._turn:
            return self._staging.read(wanted)

    def synchronize(self) -> None:
        """Wait until everything launched so far is done."""
        if self._staging is not None:
            with self._turn:
                self._staging.flush()
                self._staging.wait()

    def close(self) -> None:
        """End the threads, and wait for them; what runs is finished first."""
        with self._turn, WARP:
            self._is_closed = True
            self._team.dismiss()
        self._team.join()

    def __enter__(self) -> "Device":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Device({self.name!r}, threads={self.part_count})"


def _emulated(device: Any) -> Launcher:
    """Launches on an emulated card; it leans on Warp's inner names, which only tests may."""
    from warp_kernels.device.emulation import EmulatedLauncher

    return EmulatedLauncher(device)


def _write_span(
    staging: Staging, spans: Sequence[wp.array], number: int, begin: int, end: int
) -> None:
    """Write the range of one part into memory that the host does not see."""
    with staging.turn:
        staging.write(spans[number], np.array([[begin, end]]))


def _rows_seen(rows: ArrayRows) -> np.ndarray:
    """ArrayRows of an array on the CPU as they lie there."""
    seen = _seen_by_host(rows.array)[: rows.count]
    return seen if rows.column is None else seen[:, rows.column]


def _seen_by_host(array: wp.array) -> np.ndarray:
    """Memory of an array on the CPU as it lies there: Warp copies nothing and knows nothing of it,
    so that nobody need wait for another thread's launches."""
    view: np.ndarray = array.numpy()
    return view
