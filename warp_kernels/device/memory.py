"""Whether memory has run out: what fails then seldom says so itself.

It lives in the lowest package, as errors do, and imports nothing that would need memory.
"""

import errno

MORE_MEMORY = "close other programs, raise the limit (ulimit -v), or try a smaller --scale"
"""What to do about it."""

_NEAR = 0.85
"""Share of a limit beyond which it is taken for the reason of a failure: what was asked for last
was not granted, and does not count."""


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


def is_limit_near() -> bool:
    """Whether this process has come near to the limit of its memory, if it has one."""
    try:
        import resource

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        if limit == resource.RLIM_INFINITY:
            return False
        with open("/proc/self/status", encoding="ascii") as status:
            peak = next(line for line in status if line.startswith("VmPeak:"))
    except (ImportError, OSError, StopIteration):  # not every system has a limit or tells
        return False
    return int(peak.split()[1]) * 1024 > _NEAR * limit
