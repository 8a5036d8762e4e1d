"""Whether memory has run out: what fails then seldom says so itself.

It lives in the lowest package, as errors do, and imports nothing that would need memory.
"""

import errno
import os

from warp_kernels.errors import ShortMemoryError

try:
    import resource  # at once: what is imported when memory is short cannot be
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

MORE_MEMORY = "close other programs, raise the limit (ulimit -v), or try a smaller --scale"
"""What to do about it."""
MORE_FOR_ALL = "close other programs, or raise the limit (ulimit -v)"
"""What to do about it where nothing is drawn, or not even begun."""

_NEAR = 0.85
"""Share of a limit beyond which it is taken for the reason of a failure: what was asked for last
was not granted, and does not count."""
_LARGEST = 320 << 20
"""What is asked for at once by those that load libraries and start threads [bytes]; Warp's is the
largest."""
_LEAST = 700 << 20
"""Addresses that libraries take before anything is done [bytes]: where they get less, OpenBLAS
crashes, or looks for them for ever."""
_ROOM = 8 << 20
"""Without so much of it left a frame is not begun [bytes]: libraries crash where a little is
missing, and the line that tells of it needs some, too."""


def is_out_of_memory(error: BaseException) -> bool:
    """Whether an error comes from a lack of memory.

    Args:
        error: What was raised; its causes are looked at as well.
    """
    cause: BaseException | None = error
    while cause is not None:
        if isinstance(cause, MemoryError) or getattr(cause, "errno", None) == errno.ENOMEM:
            return True
        cause = cause.__cause__ or cause.__context__
    return is_limit_near()


def memory_limit() -> int | None:
    """What this process may take of addresses [bytes]; None if all that there is."""
    if resource is None:
        return None
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    return None if limit == resource.RLIM_INFINITY else limit


def is_limit_near() -> bool:
    """Whether this process has come near to the limit of its memory, if it has one."""
    limit = memory_limit()
    return limit is not None and _is_near(_taken(b"VmPeak:"), limit)


def was_limit_near(process: int) -> bool | None:
    """Whether another process that crashed had come near to the limit of its memory.

    Args:
        process: Its number.

    Returns:
        None if it has a limit and has ended meanwhile: nobody knows what it had.
    """
    if resource is None or not hasattr(resource, "prlimit"):  # Linux has it
        return False
    try:
        limit, _ = resource.prlimit(process, resource.RLIMIT_AS)
    except OSError:  # it is gone for good; its limit may have been that of this process
        return False if memory_limit() is None else None
    peak = _taken(b"VmPeak:", str(process))
    if limit == resource.RLIM_INFINITY or peak:
        return limit != resource.RLIM_INFINITY and _is_near(peak, limit)
    return None


def refuse_without_room() -> None:
    """Begin nothing where next to nothing is left.

    Raises:
        ShortMemoryError: If there is a limit, and no room below it.
    """
    limit = memory_limit()
    if limit is not None and limit - _taken(b"VmSize:") < _ROOM:
        raise ShortMemoryError(f"out of memory (limited to {limit / 1e6:.0f} MB); {MORE_MEMORY}")


def refuse_small_limit() -> None:
    """Begin nothing where not even the libraries can be loaded.

    Raises:
        ShortMemoryError: If there is such a limit.
    """
    limit = memory_limit()
    if limit is not None and limit < _LEAST:
        needed = f"at least {_LEAST / 1e6:.0f} MB are needed"
        raise ShortMemoryError(
            f"out of memory (limited to {limit / 1e6:.0f} MB, {needed}); {MORE_MEMORY}"
        )


def refuse_if_short(error: BaseException) -> None:
    """Let nothing be passed over as damage of a file that memory is the reason of.

    Args:
        error: What a library raised.

    Raises:
        ShortMemoryError: If the limit is near.
    """
    if is_limit_near():
        raise ShortMemoryError(f"out of memory; {MORE_MEMORY}") from error


def _is_near(peak: int, limit: int) -> bool:
    return peak > min(_NEAR * limit, limit - _LARGEST)


def peak_memory() -> int | None:
    """Most memory that this process had so far [bytes]; None where the system does not tell."""
    peak = _taken(b"VmHWM:")
    if peak or resource is None:
        return peak or None
    return int(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)  # macOS: in bytes


def _taken(name: bytes, process: str = "self") -> int:
    """A line of what the system says of a process [bytes]; 0 where it says nothing."""
    try:
        status = os.open(f"/proc/{process}/status", os.O_RDONLY)
    except OSError:  # not every system tells
        return 0
    try:
        text = os.read(status, 4096)
    finally:
        os.close(status)
    _, found, rest = text.partition(name)
    return int(rest.split(None, 1)[0]) * 1024 if found else 0
