"""How launches are recorded, captured and replayed: by Warp, or by what stands in for it."""

from collections.abc import Callable, Iterable, Sequence
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


class WarpLauncher:
    """Launches by Warp, on the CPU or on CUDA.

    Args:
        device: Warp's device.
        tell: Told how far compiling is.
    """

    def __init__(self, device: Any, tell: Told) -> None:
        self._device = device
        self._kernels = Kernels(device, tell)

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
        with WARP, quiet(), wp.ScopedCapture(device=self._device) as capture:
            for launch in launches:
                launch.launch()
        graph = capture.graph

        def replay() -> None:
            """Replay it; on the thread of who holds the lock, or of one that he waits for."""
            wp.capture_launch(graph)

        return replay

    def copy(self, target: wp.array, source: wp.array, size: int) -> None:
        """Copy bytes; they arrive later if the host's side is pinned."""
        with WARP:
            wp.copy(target, source, count=size)
