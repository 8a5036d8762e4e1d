"""How launches are recorded, captured and replayed: by Warp, or by what stands in for it.

On a card each launcher has a stream of its own: what it launches and copies happens in order, and
waits for nothing that others do.
"""

from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager
from copy import copy
from typing import Any, Protocol

import warp as wp

from warp_kernels.device.compiling.kernels import Kernels, Told, block_of
from warp_kernels.device.runtime import WARP, quiet

Graph = Callable[[], None]
"""What replays a captured sequence once."""


class Launcher(Protocol):
    """Makes kernels ready, records their launches, and captures sequences of them."""

    def expect(self, kernels: Iterable[Any]) -> None:
        """Name kernels that will be recorded: they are compiled together with the next that is."""

    @property
    def awaits_kernels(self) -> bool:
        """Whether kernels are expected that may not be compiled yet."""

    def compile_expected(self) -> None:
        """Compile what is expected, while other threads launch what is compiled."""

    def record(self, kernel: Any, arguments: Sequence[Any]) -> Any:
        """A launch of one thread that is not made yet, with `set_dim`, `bounds.size`, `launch`."""

    def capture(self, launches: Sequence[Any]) -> Graph:
        """A sequence of launches, each with the size that it has now."""

    def copy(self, target: wp.array, source: wp.array, size: int) -> None:
        """Copy bytes between host and device, without waiting; never during a capture."""

    def launch(self, launch: Any) -> None:
        """Make a recorded launch."""

    def mark(self) -> Any:
        """What to wait for, to know that everything so far is done."""

    def wait(self, mark: Any) -> None:
        """Wait for a mark; called without the lock, so that others go on launching."""

    def on_stream(self) -> AbstractContextManager[Any]:
        """Let Warp's own allocations and clearings happen in this order as well."""

    def beside(self) -> "Launcher":
        """One with a stream of its own and the same kernels."""


class WarpLauncher:
    """Launches by Warp, on the CPU or on CUDA.

    Args:
        device: Warp's device.
        tell: Told how far compiling is.
    """

    def __init__(self, device: Any, tell: Told) -> None:
        self._device = device
        self._kernels = Kernels(device, tell)
        self._stream = _new_stream(device)

    def beside(self) -> "WarpLauncher":
        """One with a stream of its own; for cards."""
        other = copy(self)
        other._stream = _new_stream(self._device)
        return other

    def on_stream(self) -> AbstractContextManager[Any]:
        """Make its stream the one that Warp takes; the lock is held meanwhile."""
        with WARP:
            scope: AbstractContextManager[Any] = wp.ScopedStream(self._stream, sync_enter=False)
        return scope

    def expect(self, kernels: Iterable[Any]) -> None:
        """Name kernels that will be recorded."""
        self._kernels.expect(kernels)

    @property
    def awaits_kernels(self) -> bool:
        """Whether kernels are expected that may not be compiled yet."""
        return self._kernels.are_awaited

    def compile_expected(self) -> None:
        """Compile what is expected; the lock is not held meanwhile, for nothing is launched."""
        with WARP:
            taken = self._kernels.take()
        with quiet():
            self._kernels.build(taken)
        with WARP:
            self._kernels.settle(taken)

    def record(self, kernel: Any, arguments: Sequence[Any]) -> Any:
        """A launch that is not made yet."""
        with WARP, quiet():
            self._kernels.make_ready(kernel)
            return wp.launch(
                kernel,
                1,
                list(arguments),
                device=self._device,
                record_cmd=True,
                block_dim=block_of(self._device),
            )

    def capture(self, launches: Sequence[Any]) -> Graph:
        """A graph of Warp's."""
        with WARP, quiet(), self.on_stream(), wp.ScopedCapture(device=self._device) as capture:
            for launch in launches:
                launch.launch()
        graph, stream = capture.graph, self._stream

        def replay() -> None:
            """Replay it; on the thread of who holds the lock, or of one that he waits for."""
            wp.capture_launch(graph, stream=stream)

        return replay

    def copy(self, target: wp.array, source: wp.array, size: int) -> None:
        """Copy bytes; they arrive later if the host's side is pinned."""
        with WARP:
            wp.copy(target, source, count=size, stream=self._stream)

    def launch(self, launch: Any) -> None:
        """Make a recorded launch."""
        with WARP:
            launch.launch(self._stream)

    def mark(self) -> Any:
        """An event; None on the CPU, where all is done at once."""
        with WARP:
            return None if self._stream is None else self._stream.record_event()

    def wait(self, mark: Any) -> None:
        """Wait for an event."""
        if mark is None:
            return
        try:
            wp.synchronize_event(mark)
        except RuntimeError:  # Warp waits for nothing while another thread captures
            with WARP:
                wp.synchronize_event(mark)


def _new_stream(device: Any) -> Any:
    """A stream of a card; None for the CPU."""
    with WARP:
        return wp.Stream(device) if device.is_cuda else None
