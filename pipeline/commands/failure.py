"""What is said of a failure, in one line, and the exit code."""

import argparse
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn

from pipeline.printable import one_line
from pipeline.progress import tell
from warp_kernels.device.memory import (
    MORE_FOR_ALL,
    MORE_MEMORY,
    is_limit_near,
    is_out_of_memory,
    memory_limit,
)
from warp_kernels.errors import MediaError, OptionError, OutputError, TrimotionError

INTERRUPTED = 130
TERMINATED = 143
LONGEST = 240
"""Letters of what a library says that are told beside a lack of memory."""
_OF_FILES = (FileNotFoundError, PermissionError, IsADirectoryError, NotADirectoryError)
"""What is a file's own fault, however little memory is left."""
_LOADING = (ImportError, SystemError)
"""How libraries fail that cannot even be loaded."""
_DRAWING = ("animate", "render", "preview")
"""Commands that have `--scale`."""


class Terminated(BaseException):
    """SIGTERM, raised in the main thread so that what is open cleans up after itself."""


def report_failure(error: BaseException, arguments: argparse.Namespace) -> int:
    """Tell about a failure in one line.

    Args:
        error: What ended the command.
        arguments: What the user gave.

    Returns:
        The exit code.
    """
    # Under a limit libraries fail in ways of their own, and options that would fit do not.
    if (isinstance(error, OptionError) or _is_of_library(error)) and is_limit_near():
        problem = str(error).split("; ")[0]  # its remedy would not help
        return _fail(f"out of memory ({problem}); {_more_memory(arguments)}", 1)
    if isinstance(error, TrimotionError):
        text = str(error).replace(MORE_MEMORY, _more_memory(arguments))
        return _fail(text, error.exit_code)
    if isinstance(error, KeyboardInterrupt):
        return _fail(f"interrupted; {_left_over(arguments)}", INTERRUPTED)
    if isinstance(error, Terminated):
        return _fail(f"terminated; {_left_over(arguments)}", TERMINATED)
    if isinstance(error, BrokenPipeError):
        # The reader of our output left. What is still buffered must not raise at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    kind = type(error).__name__
    if isinstance(error, Exception) and is_out_of_memory(error):
        remedy = _more_memory(arguments, loading=_is_loading(error))
        return _fail(f"out of memory{_reason(error)}; {remedy}", 1)
    if isinstance(error, OSError) and error.filename and error.strerror:
        reason = error.strerror.lower()
        return _fail(f"{error.filename}: {reason}; check the place, its rights and free space", 1)
    return _fail(f"internal error ({kind}: {error}); run again with --debug and report it", 1)


def _is_loading(error: Exception) -> bool:
    """Whether a library is not even there: Warp loads those of its own, and says so in words."""
    return isinstance(error, _LOADING) or "shared library" in str(error)


def _reason(error: Exception) -> str:
    """What is told of a lack of memory: the limit, which says more than a library's words."""
    limit = memory_limit()
    if limit is not None:
        return f" (limited to {limit / 1e6:.0f} MB)"
    text, kind = f"{type(error).__name__}: {error}", type(error).__name__
    told = text if len(text) < LONGEST else kind
    return "" if isinstance(error, MemoryError) else f" ({told})"


def _more_memory(arguments: argparse.Namespace, *, loading: bool = False) -> str:
    """What to do about it: only what is drawn becomes smaller with a scale."""
    return MORE_MEMORY if arguments.command in _DRAWING and not loading else MORE_FOR_ALL


def _is_of_library(error: BaseException) -> bool:
    """Whether a file is blamed for what a library said, which may have had another reason."""
    told_apart = isinstance(error, OutputError) or isinstance(error.__cause__, _OF_FILES)
    return isinstance(error, MediaError) and error.__cause__ is not None and not told_apart


def _left_over(arguments: argparse.Namespace) -> str:
    """What an interrupted command leaves."""
    if arguments.command == "solve" or (arguments.command == "animate" and "track" in arguments):
        return "the track keeps what was solved, and --resume goes on with it"
    return "no unfinished file is left"


def _fail(text: str, code: int) -> int:
    tell(f"trimotion: error: {one_line(text)}", sys.stderr)
    return code


@contextmanager
def terminable() -> Iterator[None]:
    """Raise `Terminated` on SIGTERM while the block runs."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous = signal.signal(signal.SIGTERM, _terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, previous)


def _terminate(*_: object) -> NoReturn:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # a second one must not disturb the clean-up
    raise Terminated
