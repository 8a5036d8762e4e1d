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
from collections.abc import Callable, Sequence
from functools import partial
from threading import Lock, Thread
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.device.barrier import STRIDE, address_of_sleep, meet
from warp_kernels.device.kernel_cache import settle_cache
from warp_kernels.device.kernels import Kernels, Told, tell_nobody
from warp_kernels.device.runtime import WARP, find_device, quiet, unused_card

SMALLEST_PART = 16
"""Below this many elements a second thread costs more than it saves."""
PART = "trimotion-part"
"""Name of the threads."""
MOST_GRAPHS = 64
"""Captured sequences kept: a much larger mesh needs a new one."""
STEPS_PER_OCTAVE = 8
"""Launch sizes between a power of two and the next: a part that grows a little keeps its size."""


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
    """A device and the threads that feed it; a context manager.

    Its threads end with `close`, or with the last reference to it. Arrays outlive it.

    Args:
        name: "auto" (CUDA if present), "cpu", or "cuda:N".
        threads: CPU threads; 0 for one per core. Results do not depend on it.
        tell: Told how many kernels are compiled, and of how many, where some are missing.

    Raises:
        OptionError: If there is no such device.
    """

    def __init__(self, name: str = "auto", threads: int = 0, tell: Told = tell_nobody) -> None:
        with WARP:
            self.notes = settle_cache()
        """Choices that were made, one sentence each."""
        self.warp = find_device(name)
        self.name = str(self.warp.alias)
        self.is_cuda = bool(self.warp.is_cuda)
        if name == "auto" and not self.is_cuda:
            self.notes += unused_card()
        self.part_count = 1 if self.is_cuda else max(1, threads or os.cpu_count() or 1)
        self._kernels = Kernels(self.warp, tell)
        if self.part_count > 1:
            self._kernels.expect([meet])
        self._is_closed = False
        self._team = self._new_team()

    def _new_team(self) -> "Team":
        """Threads that end when nobody refers to the device any more."""
        with WARP:
            team = Team(self.warp, self.part_count, self._kernels)
        # at exit threads that wait are no burden, and one that works must not lose its team
        weakref.finalize(self, team.dismiss).atexit = False
        return team

    def expect(self, kernels: Sequence[Any]) -> None:
        """Name kernels that will be recorded: they are compiled together with the next that is.

        Args:
            kernels: Those that take longest to compile first.
        """
        with WARP:
            self._kernels.expect(kernels)

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
        with WARP, quiet():
            self._kernels.make_ready(kernel)
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
        # no reference to the device: the team's graphs keep phases, and would keep it for ever
        if self.is_cuda:
            return partial(_write_span, spans)
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
        with WARP:
            if self._is_closed:
                raise RuntimeError(f"{self!r} was closed; make another one")
            try:
                self._team.run(phases, times)
            except BaseException:
                # an interrupt has left the team out of step: the next caller needs a new one
                self._team.abandon()
                self._team = self._new_team()
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
                source: wp.array = wp.array(values, dtype=array.dtype, device="cpu")
                wp.copy(array, source, count=source.size)
                self.synchronize()  # the host values may be gone before the copy is done
        else:
            _seen_by_host(array)[: len(values)] = values

    def read(self, array: wp.array, count: int) -> np.ndarray:
        """Copy the first `count` rows of a device array to the host."""
        if self.is_cuda:
            with WARP:
                self.synchronize()
                return np.array(array.numpy()[:count])
        return _seen_by_host(array)[:count].copy()

    def synchronize(self) -> None:
        """Wait until everything launched so far is done."""
        if self.is_cuda:
            with WARP:
                wp.synchronize_device(self.warp)

    def close(self) -> None:
        """End the threads, and wait for them; what runs is finished first."""
        with WARP:
            self._is_closed = True
            self._team.dismiss()
        self._team.join()

    def __enter__(self) -> "Device":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Device({self.name!r}, threads={self.part_count})"


class Team:
    """The calling thread and others beside it that replay captured phases in step.

    Args:
        device: Warp's device.
        size: Threads, the calling one included.
        kernels: Makes the kernel ready with which threads meet.
    """

    def __init__(self, device: Any, size: int, kernels: Kernels) -> None:
        self._device = device
        self._size = size
        self._kernels = kernels
        self._graphs: dict[Any, Any] = {}
        self._job: tuple[list[Any], int] = ([], 0)
        self._meetings: list[Any] = []
        with WARP:
            self._flags = wp.zeros((size + 1) * STRIDE, dtype=int, device=device)
        self._abandoned = False
        self._busy = [Lock() for _ in range(size)]
        self._starts = [_closed_lock() for _ in range(size)]
        self._threads = [
            Thread(target=partial(_replay_forever, self, number), daemon=True, name=PART)
            for number in range(1, size)
        ]
        for thread in self._threads:
            thread.start()

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

    def dismiss(self) -> None:
        """Let the threads end that have nothing to do; the team is not used again.

        Calls nothing of Warp: the interpreter may come here on any thread, at any moment.
        """
        self._abandoned = True
        for start in self._starts[1:]:
            if start.locked():
                start.release()

    def abandon(self) -> None:
        """Let nobody wait any more, and wait until nobody works; then threads end."""
        self.dismiss()
        with WARP:
            self._flags.fill_(1)
        for busy in self._busy:
            busy.acquire()
            busy.release()

    def join(self) -> None:
        """Wait until the threads of a dismissed team have ended."""
        for thread in self._threads:
            thread.join()

    def _graphs_of(self, phases: Sequence[Phase]) -> list[Any]:
        key = tuple((id(phase), phase.shape) for phase in phases)
        if key not in self._graphs:
            if self._size > 1 and not self._meetings:
                self._meetings = self._recorded_meetings()
            if len(self._graphs) >= MOST_GRAPHS:
                self._graphs.clear()
            graphs = [self._capture(phases, number) for number in range(self._size)]
            self._graphs[key] = (graphs, tuple(phases))  # the phases must outlive their ids
        return self._graphs[key][0]

    def _recorded_meetings(self) -> list[Any]:
        """The launch with which each thread waits for the others."""
        pause = address_of_sleep()
        with WARP, quiet():
            self._kernels.make_ready(meet)
            return [
                wp.launch(
                    meet,
                    1,
                    [number, self._size, pause, self._flags],
                    device=self._device,
                    record_cmd=True,
                )
                for number in range(self._size)
            ]

    def _capture(self, phases: Sequence[Phase], number: int) -> Any:
        with WARP, quiet(), wp.ScopedCapture(device=self._device) as capture:
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


def _write_span(spans: Sequence[wp.array], number: int, begin: int, end: int) -> None:
    """Write the range of one part into memory that the host does not see."""
    with WARP:
        spans[number].assign([[begin, end]])


def _seen_by_host(array: wp.array) -> np.ndarray:
    """Memory of an array on the CPU as it lies there: Warp copies nothing and knows nothing of it,
    so that nobody need wait for another thread's launches."""
    view: np.ndarray = array.numpy()
    return view
