"""Memory that was freed is kept for what comes next; where it is limited, some is set aside.

The C library gives large arrays back to the system when they are freed, and the system hands every
page out anew, cleared: a third of the time that a frame of a track takes to read. What is kept is
bounded, and small beside what a frame takes.

Under a limit the library is kept from looking for room again and again where there is none: with
an arena for each thread it goes on for minutes, a hundred times slower, before it gives up.
"""

from contextlib import suppress
from typing import Any

from warp_kernels.device.memory import memory_limit

TRIM_THRESHOLD, MMAP_THRESHOLD, ARENA_MAX = -1, -3, -8
"""How malloc.h names what `mallopt` sets."""
KEPT = 16 << 20
"""Most free memory that is not given back [bytes]."""
LARGE = 4 << 20
"""Arrays from this size on come from the system and go back to it [bytes]: pictures."""
SPARE = 16 << 20
"""Addresses that are set aside under a limit, to tell of its end [bytes]; nothing lies there."""
_spare: list[Any] = []


def keep_memory() -> None:
    """Set it for this process; where there is no such function, or no memory, nothing is done."""
    try:
        import ctypes  # not before failures are told: it takes memory itself

        setting = ctypes.CDLL(None).mallopt
    except (AttributeError, ImportError, MemoryError, OSError, TypeError):
        return  # macOS, musl; Windows names no such library
    setting(MMAP_THRESHOLD, LARGE)
    setting(TRIM_THRESHOLD, KEPT)
    if memory_limit() is not None:
        setting(ARENA_MAX, 1)
        with suppress(ImportError, MemoryError, OSError, ValueError):  # no room even for this
            import mmap

            _spare.append(mmap.mmap(-1, SPARE))


def release_spare() -> None:
    """Give back what was set aside: something failed, and is to be told."""
    while _spare:
        _spare.pop().close()
