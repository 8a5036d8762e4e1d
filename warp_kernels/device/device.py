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
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.device.barrier import STRIDE, meet
from warp_kernels.device.kernel_cache import settle_cache
from warp_kernels.device.kernels import Told, tell_nobody
from warp_kernels.device.launcher import Launcher, WarpLauncher
from warp_kernels.device.phase import SMALLEST_PART, Phase
from warp_kernels.device.runtime import EMULATED, WARP, find_device, unused_card
from warp_kernels.device.team import Team


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
        self._launcher = _emulated(self.warp) if emulated else WarpLauncher(self.warp, tell)
        if self.part_count > 1:
            self._launcher.expect([meet])
        self._is_closed = False
        self._team = self._new_team()

    def _new_team(self) -> Team:
        """Threads that end when nobody refers to the device any more."""
        with WARP:
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
            parts = [self._launcher.record(kernel, [span, *inputs, *outputs]) for span in spans]
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


def _emulated(device: Any) -> Launcher:
    """Launches on an emulated card; it leans on Warp's inner names, which only tests may."""
    from warp_kernels.device.emulation import EmulatedLauncher

    return EmulatedLauncher(device)


def _write_span(spans: Sequence[wp.array], number: int, begin: int, end: int) -> None:
    """Write the range of one part into memory that the host does not see."""
    with WARP:
        spans[number].assign([[begin, end]])


def _seen_by_host(array: wp.array) -> np.ndarray:
    """Memory of an array on the CPU as it lies there: Warp copies nothing and knows nothing of it,
    so that nobody need wait for another thread's launches."""
    view: np.ndarray = array.numpy()
    return view
