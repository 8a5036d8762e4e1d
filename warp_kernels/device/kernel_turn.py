"""One process at a time compiles kernels; the others wait, and find them compiled."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

LOCK = "trimotion.lock"
"""A file beside the compiled kernels that the process has locked that compiles. The system lets go
of the lock when the process ends, however it does."""
PATIENCE = 0.1
"""How often the others look [s]."""


@contextmanager
def waited_turn(folder: Path, look: Callable[[], object]) -> Iterator[None]:
    """Wait until no other process compiles, and let none while the block runs.

    Where files cannot be locked nobody waits: then two may compile the same, and either is right.

    Args:
        folder: Where compiled kernels are kept.
        look: Called while another process compiles.
    """
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
    try:
        file = open(folder / LOCK, "a+b")  # noqa: SIM115
    except OSError:
        yield
        return
    with file:
        while not _locked(file):
            look()
            time.sleep(PATIENCE)
        yield  # closing the file lets go of the lock


def _locked(file: IO[bytes]) -> bool:
    """Lock a file; False if another process has."""
    try:
        import fcntl
    except ImportError:  # Windows
        return _locked_on_windows(file)
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system that knows no locks
        pass
    return True


def _locked_on_windows(file: IO[bytes]) -> bool:
    """The same for the first byte of the file."""
    import msvcrt

    lock = getattr(msvcrt, "locking")  # noqa: B009
    try:
        file.seek(0)
        lock(file.fileno(), getattr(msvcrt, "LK_NBLCK"), 1)  # noqa: B009
    except OSError:
        return False
    return True
