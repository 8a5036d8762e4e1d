"""Locks on files: the system lets go of one when its process ends, however it does."""

from typing import IO


def locked(file: IO[bytes]) -> bool:
    """Lock a file until it is closed; False if another has locked it.

    Where a file system knows no locks, everybody has one.

    Args:
        file: Opened for writing.
    """
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
