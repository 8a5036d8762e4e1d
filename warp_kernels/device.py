"""Where kernels run: a CUDA device, or the CPU with all its cores.

Warp runs a CPU kernel on the calling thread but lets go of the interpreter lock meanwhile, so a
launch is recorded as one part per core, over disjoint ranges, and a small team of threads runs
the parts at once. On CUDA a launch has one part, and a round of iterations is captured in a graph.

Every kernel's first parameter is `begin`, the first element of its part.
"""

import os
import sys
from collections.abc import Sequence
from queue import SimpleQueue
from threading import Lock, Semaphore, Thread
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.errors import OptionError

SMALLEST_PART = 16
"""Below this many elements a second thread costs more than it saves."""
MOST_GRAPHS = 64
"""Captured sequences kept: a new number of triangles needs a new one."""


class Phase:
    """One recorded launch: all parts may run at once, and end before the next phase begins.

    Args:
        parts: Recorded Warp launches of one kernel, to be spread over disjoint ranges.
        per_element: Kernel threads per element.
    """

    def __init__(self, parts: Sequence[Any], per_element: int) -> None:
        self.parts = tuple(parts)
        self.count = 0
        self._per_element = per_element

    def resize(self, count: int, *, per_element: int | None = None) -> None:
        """Spread `count` elements over the parts, of `per_element` threads if that changes."""
        if per_element is not None:
            self._per_element = per_element
        self.count = count
        share = max(-(-count // len(self.parts)), SMALLEST_PART)
        for number, part in enumerate(self.parts):
            begin = min(number * share, count)
            part.set_param_at_index(0, begin * self._per_element)
            part.set_dim(min(share, count - begin) * self._per_element)


class Device:
    """A device and the threads that feed it.

    Args:
        name: "auto" (CUDA if present), "cpu", or "cuda:N".
        threads: CPU threads; 0 for one per core. Results do not depend on it.

    Raises:
        OptionError: If there is no such device.
    """

    def __init__(self, name: str = "auto", threads: int = 0) -> None:
        _start_warp()
        if name == "auto":
            name = "cuda:0" if wp.get_cuda_device_count() else "cpu"
        self.name = name
        self.warp = _warp_device(name)
        self.is_cuda = bool(self.warp.is_cuda)
        self.part_count = 1 if self.is_cuda else max(1, threads or os.cpu_count() or 1)
        self._graphs: dict[Any, Any] = {}
        self._team = _Team(self.part_count - 1) if self.part_count > 1 else None

    def record(
        self, kernel: Any, inputs: Sequence[Any], outputs: Sequence[Any], *, per_element: int = 1
    ) -> Phase:
        """Record the launch of `kernel`, split over the threads; `Phase.resize` sets its size."""
        parts = [
            wp.launch(kernel, 1, [0, *inputs], list(outputs), device=self.warp, record_cmd=True)
            for _ in range(self.part_count)
        ]
        return Phase(parts, per_element)

    def run(self, phases: Sequence[Phase], times: int = 1) -> None:
        """Run the phases one after the other, `times` times over.

        On CUDA a repeated sequence is captured in a graph: no host round trip inside.
        """
        if self.is_cuda:
            self._run_on_cuda(phases, times)
        elif self._team is None:
            for _ in range(times):
                for phase in phases:
                    phase.parts[0].launch()
        else:
            self._team.run(phases, times)

    def _run_on_cuda(self, phases: Sequence[Phase], times: int) -> None:
        if times == 1:
            for phase in phases:
                phase.parts[0].launch()
            return
        graph = self._graph(phases)
        for _ in range(times):
            wp.capture_launch(graph)

    def _graph(self, phases: Sequence[Phase]) -> Any:
        key = tuple((id(phase), phase.count) for phase in phases)
        if key not in self._graphs:
            if len(self._graphs) >= MOST_GRAPHS:
                self._graphs.clear()
            with wp.ScopedCapture(device=self.warp) as capture:
                for phase in phases:
                    phase.parts[0].launch()
            self._graphs[key] = (capture.graph, tuple(phases))  # the phases must outlive their ids
        return self._graphs[key][0]

    def write(self, array: wp.array, values: np.ndarray) -> None:
        """Copy host values into the beginning of a device array."""
        if self.is_cuda:
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


class _Team:
    """Threads that run the parts of a phase beside the calling thread."""

    def __init__(self, size: int) -> None:
        self._lock = Lock()
        self._done = Semaphore(0)
        self._queues: list[SimpleQueue[Any]] = [SimpleQueue() for _ in range(size)]
        for queue in self._queues:
            Thread(target=self._work, args=(queue,), daemon=True, name="trimotion-part").start()

    def _work(self, queue: SimpleQueue[Any]) -> None:
        while True:
            part = queue.get()
            part.launch()
            self._done.release()

    def run(self, phases: Sequence[Phase], times: int) -> None:
        """Run phases one after the other, the parts of each at once."""
        with self._lock:
            for _ in range(times):
                for phase in phases:
                    self._run_phase(phase)

    def _run_phase(self, phase: Phase) -> None:
        busy = [
            (queue, part)
            for queue, part in zip(self._queues, phase.parts[1:], strict=True)
            if part.bounds.size > 0
        ]
        for queue, part in busy:
            queue.put(part)
        phase.parts[0].launch()
        for _ in busy:
            self._done.acquire()


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
