"""`jobs=N` from a program: the new processes import that program first, and must not run it again.

Source: Python's multiprocessing, "the spawn and forkserver start methods".
"""

import multiprocessing
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from warp_kernels.errors import OptionError

GUARD = 'if __name__ == "__main__":'


def check_processes(jobs: int) -> None:
    """Refuse to start processes where that would go wrong.

    Args:
        jobs: How many are wanted.

    Raises:
        OptionError: If this is itself a process that only imports the program, or may have none.
    """
    current = multiprocessing.current_process()
    if jobs > 1 and getattr(current, "_inheriting", False):
        raise OptionError(
            f"--jobs {jobs}: a new process imports your program and would run it again; put the "
            f"call under {GUARD}"
        )
    if jobs > 1 and current.daemon:
        raise OptionError(f"--jobs {jobs}: a daemonic process cannot start others; use --jobs 1")


@contextmanager
def explained_loss(jobs: int) -> Iterator[None]:
    """Say what may be the matter with the program if a process is lost.

    Args:
        jobs: How many are wanted.

    Raises:
        OptionError: If one is lost, and new ones import the program.
    """
    if jobs == 1:
        yield
        return
    from pipeline.loop.processes import LostPartError

    try:
        yield
    except LostPartError as error:
        if _is_imported_again():
            raise OptionError(
                f"{error}; if the call stands outside of {GUARD} in your program, put it there"
            ) from error
        raise


def _is_imported_again() -> bool:
    """Whether new processes import the main program; a notebook has none that could be."""
    return getattr(sys.modules.get("__main__"), "__file__", None) is not None
