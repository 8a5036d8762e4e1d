"""Warp itself: started without a word, used by one thread at a time, and left as it was found."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from threading import Lock, RLock
from typing import Any

import warp as wp

from warp_kernels.errors import OptionError

WARP = RLock()
"""Held around every call that launches, copies, allocates or captures, and by whoever waits for
such a call: a capture on the CPU records the launches of all threads, and on CUDA a copy changes
the stream on which another thread captures."""
EMULATED = "cuda-emulated"
"""Name of a device for tests: the code for CUDA, run by the CPU."""
ERRORS = 2
"""Number of the stream for errors of every process."""

_started = False
_HUSH = Lock()
_hushed, _usual = 0, 0  # how many want quiet, and the level before the first of them did


@contextmanager
def quiet() -> Iterator[None]:
    """Keep Warp from telling what it compiles: a command's output is its own.

    Of several threads the last one ends it: one may compile for long, beside which others launch.
    """
    global _hushed, _usual
    with _HUSH:
        if not _hushed:
            _usual = wp.config.log_level
            wp.config.log_level = max(_usual, wp.LOG_ERROR)
        _hushed += 1
    try:
        yield
    finally:
        with _HUSH:
            _hushed -= 1
            if not _hushed:
                wp.config.log_level = _usual


def find_device(name: str) -> Any:
    """Start Warp if nobody has, and find one of its devices.

    Args:
        name: "auto" (CUDA if present), "cpu", "cuda:N", or "cuda-emulated" (the CPU's memory).

    Raises:
        OptionError: If there is no such device.
    """
    with WARP:
        _start()
        if name == "auto":
            name = "cuda:0" if wp.get_cuda_device_count() else "cpu"
        elif name == EMULATED:
            name = "cpu"
        try:
            return wp.get_device(name)
        except Exception as error:  # Warp raises several types for an unknown device
            found = ", ".join(device.alias for device in wp.get_devices())
            reason = driver_problem(driver_version(), toolkit_version())
            raise OptionError(
                f"--device {name}: no such device{reason}; use one of: auto, {found}"
            ) from error


def unused_card() -> tuple[str, ...]:
    """A sentence if CUDA is there and cannot be used, for who asked for no device in particular."""
    problem = driver_problem(driver_version(), toolkit_version())
    return (f"the CPU is used{problem}",) if problem else ()


def toolkit_version() -> tuple[int, int] | None:
    """Version of CUDA that this build of Warp was made with, or None without CUDA."""
    with WARP:
        found: tuple[int, int] | None = wp.get_cuda_toolkit_version()
    return found


def _start() -> None:
    """Start Warp, once in a process.

    Its native part reports a missing CUDA driver on the error stream itself, whatever the log
    level, so that stream is put aside meanwhile.
    """
    global _started
    if not _started:
        with WARP, quiet(), _errors_aside():
            wp.init()
        _started = True


@contextmanager
def _errors_aside() -> Iterator[None]:
    """Lose what native code writes to the error stream."""
    if sys.stderr is not None:
        sys.stderr.flush()
    try:
        kept = os.dup(ERRORS)
    except OSError:  # a process without one
        yield
        return
    try:
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), ERRORS)
        yield
    finally:
        os.dup2(kept, ERRORS)
        os.close(kept)


def driver_version() -> tuple[int, int] | None:
    """Version of CUDA that the installed driver knows, or None if there is no driver."""
    version = ctypes.c_int(0)
    for name in ("libcuda.so.1", "nvcuda.dll"):
        with suppress(OSError, AttributeError):
            if ctypes.CDLL(name).cuDriverGetVersion(ctypes.byref(version)) == 0:
                return version.value // 1000, version.value % 1000 // 10
    return None


def driver_problem(installed: tuple[int, int] | None, needed: tuple[int, int] | None) -> str:
    """Why no CUDA device is found although there is a driver, for a message; else nothing.

    Args:
        installed: Version of CUDA that the driver knows, or None without one.
        needed: The one that this build of Warp was made with, or None without CUDA.
    """
    if installed is None or needed is None or installed >= (needed[0], 0):
        return ""
    return (
        f" (the driver knows CUDA {installed[0]}.{installed[1]}, and this Warp needs "
        f"{needed[0]}.0: update the driver, or install a Warp for the older one)"
    )
