"""A crash of a library ends as one line, too.

FFmpeg and others run inside this process; where one of them aborts it, Python gets no chance to say
anything. Its fault handler does, into a pipe, and a second process that does nothing else reads the
pipe. It costs a fork before anything is imported. Others end it without a word where they get no
memory (OpenBLAS): a run that never said that it had ended is told of if its memory is limited.
"""

import faulthandler
import os
import re
import signal
import sys
from contextlib import suppress
from typing import IO

from warp_kernels.device.memory import MORE_MEMORY, was_limit_near

_REASON = re.compile(rb"Fatal Python error: ([^\n]+)")
_DONE = b"done\n"
"""What is written by a run that ends by itself."""
_kept: list[IO[bytes]] = []
"""The pipe's end: the fault handler only borrows it."""


def watch_for_crashes() -> None:
    """Start the second process; it ends with this one. Where there is no fork nothing is done."""
    if not hasattr(os, "fork") or sys.stderr is None:
        return
    try:
        reading, writing = os.pipe()
        watched = os.getpid()
        if os.fork() == 0:
            os.close(writing)
            _report(reading, watched)
    except OSError:
        return  # no process to be had: it goes without
    os.close(reading)
    end = os.fdopen(writing, "wb", buffering=0)
    _kept.append(end)
    faulthandler.enable(end)


def end_watch() -> None:
    """Say that this process ends by itself, whether well or not."""
    for end in _kept:
        with suppress(OSError):  # the second process was killed
            end.write(_DONE)


def _report(reading: int, watched: int) -> None:
    """Wait for the other process to end, and say why if it crashed."""
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        told = os.read(reading, 4096)
        short = was_limit_near(watched)  # while it still writes, if it does
        while part := os.read(reading, 4096):
            told += part
        found = _REASON.search(told)
        line = None
        if found:
            line = _line(found[1].decode("ascii", "replace").lower(), short)
        elif _DONE not in told and short is not False:
            line = f"ended by a library or from outside, and memory is limited; {MORE_MEMORY}"
        if line is not None:
            os.write(2, f"trimotion: error: {line}\n".encode())
    finally:
        os._exit(0)


def _line(reason: str, short: bool | None) -> str:
    """What is said of a crash, with a lack of memory as its reason, as one that may be, or none."""
    if short:
        return f"out of memory (a library crashed: {reason}); {MORE_MEMORY}"
    remedy = "convert that with another program first, and report it"
    if short is None:
        return (
            f"a library crashed ({reason}), and memory is limited: if it ran out, {MORE_MEMORY}; "
            f"if a file was being read, {remedy}"
        )
    return f"a library crashed ({reason}); if it was reading a file, {remedy}"
