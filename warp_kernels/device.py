"""Where kernels run: a CUDA device, or the CPU with all its cores.

Warp runs a CPU kernel on the calling thread but lets go of the interpreter lock meanwhile, so a
launch is recorded as one part per core, over disjoint ranges, and a small team of threads runs
the parts at once. On CUDA a launch has one part, and a round of iterations is captured in a graph.

Every kernel's first parameter is `begin`, the first element of its part.
"""

import os
import sys
from collections.abc import Sequence
from threading import Lock, Thread
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
        smallest_part: Elements below which a second part costs more than it saves.
    """

    def __init__(
        self, parts: Sequence[Any], per_element: int, smallest_part: int = SMALLEST_PART
    ) -> None:
        self.parts = tuple(parts)
        self.count = 0
        self._per_element = per_element
        self._smallest_part = smallest_part

    @property
    def is_whole(self) -> bool:
        """Whether the first part does everything."""
        return all(part.bounds.size == 0 for part in self.parts[1:])

    def resize(self, count: int, *, per_element: int | None = None) -> None:
        """Spread `count` elements over the parts, of `per_element` threads if that changes."""
        if per_element is not None:
            self._per_element = per_element
        self.count = count
        share = max(-(-count // len(self.parts)), self._smallest_part)
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
        self._calling = Lock()
        self._team = _Team(self.part_count) if self.part_count > 1 else None

    def record(
        self,
        kernel: Any,
        inputs: Sequence[Any],
        outputs: Sequence[Any],
        *,
        per_element: int = 1,
        smallest_part: int = SMALLEST_PART,
    ) -> Phase:
        """Record the launch of `kernel`, split over the threads; `Phase.resize` sets its size."""
        parts = [
            wp.launch(kernel, 1, [0, *inputs], list(outputs), device=self.warp, record_cmd=True)
            for _ in range(self.part_count)
        ]
        return Phase(parts, per_element, smallest_part)

    def run(self, phases: Sequence[Phase], times: int = 1) -> None:
        """Run the phases one after the other, `times` times over.

        On CUDA a repeated sequence is captured in a graph: no host round trip inside.
        """
        if times == 0:
            return  # the team would wait for threads that were never started
        if self.is_cuda:
            self._run_on_cuda(phases, times)
        elif self._team is None:
            for _ in range(times):
                for phase in phases:
                    phase.parts[0].launch()
        else:
            self._run_on_team(phases, times)

    def _run_on_team(self, phases: Sequence[Phase], times: int) -> None:
        with self._calling:
            try:
                self._team.run(phases, times)
            except BaseException:
                # an interrupt has left the team out of step: the next caller needs a new one
                self._team = _Team(self.part_count)
                raise

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
    """The calling thread and others beside it that run a sequence of phases in step.

    Each thread runs its own part of every phase, and all meet between two phases. Whoever comes
    last opens the gates and goes on at once, so a phase costs one waking up and not two, as it
    would with a foreman who hands out parts. Gates are plain locks: nobody waits busily.
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._counting = Lock()
        self._arrived = 0
        self._job: tuple[Sequence[Phase], int] = ((), 0)
        self._starts = [Lock() for _ in range(size)]
        self._gates = [Lock() for _ in range(size)]
        for lock in self._starts + self._gates:
            lock.acquire()
        for number in range(1, size):
            Thread(target=self._work, args=(number,), daemon=True, name="trimotion-part").start()

    def run(self, phases: Sequence[Phase], times: int) -> None:
        """Run phases one after the other, the parts of each at once."""
        self._job = (phases, times)
        if times and not all(phase.is_whole for phase in phases):
            for start in self._starts[1:]:
                start.release()
        self._run_parts(0)

    def _work(self, number: int) -> None:
        while True:
            self._starts[number].acquire()
            self._run_parts(number)

    def _run_parts(self, number: int) -> None:
        phases, times = self._job
        whole = [phase.is_whole for phase in phases]
        # whole phases in a row are the caller's own: between them there is nobody to wait for
        steps = [
            (phase.parts[number], not (whole[n] and whole[n - 1])) for n, phase in enumerate(phases)
        ]
        begun = False
        for _ in range(times):
            for part, is_shared in steps:
                if is_shared and begun:
                    self._meet(number)
                begun = True
                if part.bounds.size > 0:
                    part.launch()
        if not whole[-1]:
            self._meet(number)

    def _meet(self, number: int) -> None:
        """Wait until every thread of the team has come here."""
        with self._counting:
            self._arrived = (self._arrived + 1) % self._size
            is_last = self._arrived == 0
        if is_last:
            for other, gate in enumerate(self._gates):
                if other != number:
                    gate.release()
        else:
            self._gates[number].acquire()


def _warp_device(name: str) -> Any:
    try:
        return wp.get_device(name)
    except Exception as error:  # Warp raises several types for an unknown device
        found = ", ".join(device.alias for device in wp.get_devices())
        raise OptionError(f"--device {name}: no such device; use one of: auto, {found}") from error


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
