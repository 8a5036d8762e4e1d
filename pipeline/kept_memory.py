"""Memory that was freed is kept for what comes next.

The C library gives large arrays back to the system when they are freed, and the system hands every
page out anew, cleared: a third of the time that a frame of a track takes to read. What is kept is
bounded, and small beside what a frame takes.
"""

import ctypes

TRIM_THRESHOLD, MMAP_THRESHOLD = -1, -3
"""How malloc.h names what `mallopt` sets."""
KEPT = 16 << 20
"""Most free memory that is not given back [bytes]."""
LARGE = 4 << 20
"""Arrays from this size on come from the system and go back to it [bytes]: pictures."""


def keep_memory() -> None:
    """Set it for this process; where there is no such function nothing is done."""
    try:
        setting = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError, TypeError):  # macOS, musl; Windows names no such library
        return
    setting(MMAP_THRESHOLD, LARGE)
    setting(TRIM_THRESHOLD, KEPT)
