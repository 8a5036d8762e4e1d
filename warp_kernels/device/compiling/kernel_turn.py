"""One process at a time compiles kernels; the others wait, and find them compiled."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from warp_kernels.device.file_lock import locked

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
        while not locked(file):
            look()
            time.sleep(PATIENCE)
        yield  # closing the file lets go of the lock
