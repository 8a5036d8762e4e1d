"""The kernels of a device: compiled together and on all cores, when the first of them is needed.

A kernel is compiled once on a machine, in about a second; a job needs a dozen. So those that will
be needed are named before: all that are missing in Warp's cache are compiled at once, and whoever
waits is told how far that is. Of several processes one compiles and the others wait for it.

All are named before any is compiled: see `stable_names.py`.
"""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any

import warp as wp

from warp_kernels.device.compiling.headers import headers_are_read, shared_headers
from warp_kernels.device.compiling.kernel_turn import waited_turn
from warp_kernels.device.compiling.stable_names import forget_loop_constants
from warp_kernels.device.compiling.whole_kernels import remove_broken

MOST_COMPILERS = 8
"""Threads that compile."""
COMPILER = "trimotion-compiler"
"""Name of these threads."""
CUDA_BLOCK = 64
"""Threads of a block on a card; on the CPU it is one. A mesh has a few thousand elements: in blocks
of 256, as Warp would have them, they would keep a few of a card's processors busy."""

_pool: ThreadPoolExecutor | None = None
"""The threads that an early start has left: they have read the headers."""

Told = Callable[[int, int], object]
"""Is told how many of how many kernels are compiled, the first time before any is."""


def tell_nobody(done: int, total: int) -> None:
    """Compile in silence."""


class Kernels:
    """Which kernels of a device are ready, and which are awaited.

    Args:
        device: Warp's device.
        tell: Told how far compiling is; nothing if all are compiled already.
    """

    def __init__(self, device: Any, tell: Told) -> None:
        self._device = device
        self._tell = tell
        self._awaited: dict[Any, None] = {}
        self._ready: set[Any] = set()

    def expect(self, kernels: Iterable[Any]) -> None:
        """Name kernels that will be needed, those first that take longest to compile."""
        self._awaited.update(dict.fromkeys(kernels))

    def make_ready(self, kernel: Any) -> None:
        """Compile a kernel and all that are expected, unless they are compiled already."""
        if kernel in self._ready:
            return
        self._awaited.setdefault(kernel)
        modules = self.take()
        self._ready.update(modules)
        self.build(modules)

    @property
    def are_awaited(self) -> bool:
        """Whether kernels are expected of which it is not known that they are compiled."""
        return not self._awaited.keys() <= self._ready

    def take(self) -> dict[Any, Any]:
        """The modules of all kernels that are expected, by kernel; they are expected no more."""
        taken, self._awaited = self._awaited, {}
        return {kernel: kernel.module for kernel in taken if kernel not in self._ready}

    def settle(self, taken: dict[Any, Any]) -> None:
        """Kernels were compiled by `build`.

        Args:
            taken: What `take` gave.
        """
        self._ready.update(taken)

    def build(self, taken: dict[Any, Any]) -> None:
        """Compile what is missing.

        Args:
            taken: What `take` gave.
        """
        modules = dict.fromkeys(taken.values())
        folder = _folder()
        # all names before the first compilation
        places = {module: folder / self._name(module) for module in modules}
        remove_broken(places.values(), folder, lambda: None)
        missing = _missing(places)
        if not missing:
            return
        total = len(missing)
        told = -1

        def look() -> None:
            """Tell how far it is, here or in the process that compiles, if that is news."""
            nonlocal told
            done = total - len(_missing(missing))
            if done != told:
                told = done
                self._tell(done, total)

        look()
        with waited_turn(folder, look):
            self._compile(list(_missing(missing)), look)

    def _name(self, module: Any) -> str:
        """Of the folder of a compiled module."""
        return str(module.get_module_identifier(block_of(self._device)))

    def _compile(self, modules: list[Any], look: Callable[[], None]) -> None:
        """Compile modules side by side, and look after each."""
        pool = _take_pool()
        compiled = list(modules)
        try:
            if modules and self._device.is_cpu and not headers_are_read(_folder()):
                # the shortest, last, while the others would only read the same headers
                _begin(pool, modules.pop(), self._device).result()
                look()
            jobs = [_begin(pool, module, self._device) for module in modules]
            for job in as_completed(jobs):
                job.result()
                look()
            look()
            forget_loop_constants(compiled)
        finally:
            pool.shutdown(cancel_futures=True)


def compile_early(device: Any, kernels: list[Any]) -> None:
    """Compile kernels that every job needs, one after the other; the threads are kept for others.

    Args:
        device: Warp's device.
        kernels: Kernels of modules of their own files.
    """
    global _pool
    _pool = _take_pool()
    with waited_turn(_folder(), lambda: None):
        for kernel in kernels:  # one reads the headers for all
            _begin(_pool, kernel.module, device).result()


def _begin(pool: ThreadPoolExecutor, module: Any, device: Any) -> Future[None]:
    """Begin to compile a module in a thread of the pool, whose owner holds the lock of Warp."""
    block = block_of(device)
    return pool.submit(_with_headers, wp.load_module, module, device, block_dim=block)


def _with_headers(work: Callable[..., object], *given: Any, **named: Any) -> None:
    """Work where the headers that were read before are at hand."""
    with shared_headers(_folder()):
        work(*given, **named)


def _folder() -> Path:
    """Where compiled kernels are kept."""
    return Path(wp.config.kernel_cache_dir or "")


def block_of(device: Any) -> int:
    """Threads of a block of a launch."""
    return 1 if device.is_cpu else CUDA_BLOCK


def _take_pool() -> ThreadPoolExecutor:
    """Threads that compile: the compiler lets go of the interpreter's lock."""
    global _pool
    pool, _pool = _pool, None
    return pool or ThreadPoolExecutor(min(_cores(), MOST_COMPILERS), COMPILER)


def _missing(places: dict[Any, Path]) -> dict[Any, Path]:
    """What is not compiled."""
    return {module: place for module, place in places.items() if not place.exists()}


def _cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
