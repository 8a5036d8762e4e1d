"""Where kernels run: a CUDA device, or the CPU with all its cores.

Launches are recorded once and captured into graphs, which Warp replays without the interpreter.
On CUDA a sequence of phases is one graph. On the CPU Warp runs a kernel on the calling thread, so
a launch is recorded as one part per core, over disjoint ranges; every thread of a team replays a
graph of its own parts, and they meet between two phases.

Every kernel's first parameter is `span`, the first element of its part and the one past its last,
in device memory: a graph outlives changes of the mesh as long as no part outgrows its launch.
"""

import os
import sys
from collections.abc import Callable, Sequence
from functools import partial
from threading import Lock, RLock, Thread
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.errors import OptionError
from warp_kernels.kernel_cache import settle_cache
from warp_kernels.meet import STRIDE, address_of_sleep, meet

SMALLEST_PART = 16
"""Below this many elements a second thread costs more than it saves."""
MOST_GRAPHS = 64
"""Captured sequences kept: a much larger mesh needs a new one."""
STEPS_PER_OCTAVE = 8
"""Launch sizes between a power of two and the next: a part that grows a little keeps its size."""

WARP = RLock()
"""Held by whoever uses Warp: its CPU capture records the launches of every thread."""


class Phase:
    """One recorded launch: all parts may run at once, and end before the next phase begins.

    Args:
        parts: Recorded Warp launches of one kernel, to be spread over disjoint ranges.
        set_span: Writes the range of a part, by the part's number, into device memory.
        per_element: Kernel threads per element.
        smallest_part: Elements below which a second part costs more than it saves.
        flows_on: Whether the next phase's parts look only at what the same part of this one wrote:
            then no part waits for another between the two.
    """

    def __init__(
        self,
        parts: Sequence[Any],
        set_span: Callable[[int, int, int], None],
        per_element: int,
        smallest_part: int,
        flows_on: bool = False,
    ) -> None:
        self.parts = tuple(parts)
        self.flows_on = flows_on
        self.shape = self._launch_sizes()
        self._size: tuple[int, int, int | None] = (0, 0, None)
        self._set_span = set_span
        self._per_element = per_element
        self._smallest_part = smallest_part

    def resize(
        self, count: int, *, per_element: int | None = None, threads: int | None = None
    ) -> None:
        """Spread `count` elements over the parts.

        Args:
            count: Elements.
            per_element: Kernel threads per element, if that changes.
            threads: Kernel threads of each part, if they are not for its elements: each looks at
                another thing and asks what it means for all elements of the part.
        """
        if per_element is not None:
            self._per_element = per_element
        if self._size == (count, self._per_element, threads):
            return
        self._size = (count, self._per_element, threads)
        share = max(-(-count // len(self.parts)), self._smallest_part)
        for number, part in enumerate(self.parts):
            begin = min(number * share, count) * self._per_element
            end = min((number + 1) * share, count) * self._per_element
            self._set_span(number, begin, end)
            needed = end - begin if threads is None or begin == end else threads
            part.set_dim(_launch_size(needed))
        self.shape = self._launch_sizes()

    def _launch_sizes(self) -> tuple[int, ...]:
        """Size of each part's launch, at least that of its range."""
        return tuple(int(part.bounds.size) for part in self.parts)


class Device:
    """A device and the threads that feed it.

    Args:
        name: "auto" (CUDA if present), "cpu", or "cuda:N".
        threads: CPU threads; 0 for one per core. Results do not depend on it.

    Raises:
        OptionError: If there is no such device.
    """

    def __init__(self, name: str = "auto", threads: int = 0) -> None:
        self.notes = settle_cache()
        """Choices that were made, one sentence each."""
        _start_warp()
        if name == "auto":
            name = "cuda:0" if wp.get_cuda_device_count() else "cpu"
        self.name = name
        self.warp = _warp_device(name)
        self.is_cuda = bool(self.warp.is_cuda)
        self.part_count = 1 if self.is_cuda else max(1, threads or os.cpu_count() or 1)
        self._team = Team(self.warp, self.part_count)

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
        with WARP:
            spans = [wp.zeros(1, dtype=wp.vec2i, device=self.warp) for _ in range(self.part_count)]
            parts = [
                wp.launch(
                    kernel, 1, [span, *inputs], list(outputs), device=self.warp, record_cmd=True
                )
                for span in spans
            ]
        return Phase(parts, self._span_writer(spans), per_element, smallest_part, flows_on)

    def _span_writer(self, spans: Sequence[wp.array]) -> Callable[[int, int, int], None]:
        """A function that writes a part's range; on the CPU straight into its memory."""
        if self.is_cuda:
            return lambda number, begin, end: spans[number].assign([[begin, end]])
        views = [span.numpy()[0] for span in spans]

        def write(number: int, begin: int, end: int) -> None:
            """Write the range of one part."""
            views[number][:] = (begin, end)

        return write

    def run(self, phases: Sequence[Phase], times: int = 1) -> None:
        """Run the phases one after the other, `times` times over, without the interpreter.

        Args:
            phases: What to run.
            times: How often; may be 0.
        """
        if times == 0:
            return
        with WARP:
            try:
                self._team.run(phases, times)
            except BaseException:
                # an interrupt has left the team out of step: the next caller needs a new one
                self._team.abandon()
                self._team = Team(self.warp, self.part_count)
                raise

    def empty(self, shape: Any, dtype: Any) -> wp.array:
        """A new device array; only workspaces ask for one."""
        with WARP:
            return wp.empty(shape, dtype=dtype, device=self.warp)

    def clear(self, array: wp.array) -> None:
        """Fill a device array with zeros."""
        with WARP:
            array.zero_()

    def write(self, array: wp.array, values: np.ndarray) -> None:
        """Copy host values into the beginning of a device array."""
        if self.is_cuda:
            with WARP:
                source = wp.array(values, dtype=array.dtype, device="cpu")
                wp.copy(array, source, count=source.size)
                self.synchronize()  # the host values may be gone before the copy is done
        else:
            array.numpy()[: len(values)] = values

    def read(self, array: wp.array, count: int) -> np.ndarray:
        """Copy the first `count` rows of a device array to the host."""
        self.synchronize()
        return array.numpy()[:count].copy()

    def synchronize(self) -> None:
        """Wait until everything launched so far is done."""
        if self.is_cuda:
            wp.synchronize_device(self.warp)

    def __repr__(self) -> str:
        return f"Device({self.name!r}, threads={self.part_count})"


class Team:
    """The calling thread and others beside it that replay captured phases in step.

    Args:
        device: Warp's device.
        size: Threads, the calling one included.
    """

    def __init__(self, device: Any, size: int) -> None:
        self._device = device
        self._size = size
        self._graphs: dict[Any, Any] = {}
        self._job: tuple[list[Any], int] = ([], 0)
        self._flags = wp.zeros((size + 1) * STRIDE, dtype=int, device=device)
        self._meetings: list[Any] = []
        if size > 1:
            pause = address_of_sleep()
            self._meetings = [
                wp.launch(
                    meet, 1, [number, size, pause, self._flags], device=device, record_cmd=True
                )
                for number in range(size)
            ]
        self._abandoned = False
        self._busy = [Lock() for _ in range(size)]
        self._starts = [_closed_lock() for _ in range(size)]
        for number in range(1, size):
            work = partial(_replay_forever, self, number)
            Thread(target=work, daemon=True, name="trimotion-part").start()

    def run(self, phases: Sequence[Phase], times: int) -> None:
        """Replay phases `times` times over, the parts of each phase at once."""
        self._job = (self._graphs_of(phases), times)
        for start in self._starts[1:]:
            start.release()
        self.replay(0)

    def replay(self, number: int) -> None:
        """Do one thread's part of the job; the last phase ends with a meeting as well."""
        graphs, times = self._job
        with self._busy[number]:
            for _ in range(times):
                if self._abandoned:
                    return
                wp.capture_launch(graphs[number])

    def wait_for_start(self, number: int) -> bool:
        """Sleep until there is a job for a thread; whether the team goes on."""
        self._starts[number].acquire()
        return not self._abandoned

    def abandon(self) -> None:
        """Let nobody wait any more, and wait until nobody works: the team is not used again."""
        self._abandoned = True
        self._flags.fill_(1)
        for busy in self._busy:
            busy.acquire()
            busy.release()

    def _graphs_of(self, phases: Sequence[Phase]) -> list[Any]:
        key = tuple((id(phase), phase.shape) for phase in phases)
        if key not in self._graphs:
            if len(self._graphs) >= MOST_GRAPHS:
                self._graphs.clear()
            graphs = [self._capture(phases, number) for number in range(self._size)]
            self._graphs[key] = (graphs, tuple(phases))  # the phases must outlive their ids
        return self._graphs[key][0]

    def _capture(self, phases: Sequence[Phase], number: int) -> Any:
        with wp.ScopedCapture(device=self._device) as capture:
            for phase in phases:
                part = phase.parts[number]
                if part.bounds.size > 0:
                    part.launch()
                if self._meetings and not (phase.flows_on and phase is not phases[-1]):
                    self._meetings[number].launch()
        return capture.graph


def _replay_forever(team: Team, number: int) -> None:
    while team.wait_for_start(number):
        team.replay(number)


def _closed_lock() -> Lock:
    lock = Lock()
    lock.acquire()
    return lock


def _launch_size(needed: int) -> int:
    """A launch size of a coarse grid that holds `needed` threads."""
    if needed == 0:
        return 0
    step = max(1, (1 << (needed - 1).bit_length()) // (2 * STEPS_PER_OCTAVE))
    return -(-needed // step) * step


def _start_warp() -> None:
    """Start Warp without a word: a command's output is its own.

    Its native part reports a missing CUDA driver on the error stream itself, whatever the log
    level, so that stream is put aside meanwhile.
    """
    wp.config.log_level = wp.LOG_ERROR
    sys.stderr.flush()
    kept = os.dup(2)
    try:
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), 2)
        wp.init()
    finally:
        os.dup2(kept, 2)
        os.close(kept)


def _warp_device(name: str) -> Any:
    try:
        return wp.get_device(name)
    except Exception as error:  # Warp raises several types for an unknown device
        found = ", ".join(device.alias for device in wp.get_devices())
        raise OptionError(f"--device {name}: no such device; use one of: auto, {found}") from error
