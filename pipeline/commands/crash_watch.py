"""A crash of a library ends as one line, too.

FFmpeg and others run inside this process; where one of them aborts it, Python gets no chance to say
anything. Its fault handler does, into a pipe, and a second process that does nothing else reads the
pipe. It costs a fork before anything is imported.
"""

import faulthandler
import os
import re
import signal
import sys

_REASON = re.compile(rb"Fatal Python error: ([^\n]+)")
_kept: list[object] = []
"""The pipe's end: the fault handler only borrows it."""


def watch_for_crashes() -> None:
    """Start the second process; it ends with this one. Where there is no fork nothing is done."""
    if not hasattr(os, "fork") or sys.stderr is None:
        return
    try:
        reading, writing = os.pipe()
        if os.fork() == 0:
            os.close(writing)
            _report(reading)
    except OSError:
        return  # no process to be had: it goes without
    os.close(reading)
    end = os.fdopen(writing, "wb", buffering=0)
    _kept.append(end)
    faulthandler.enable(end)


def _report(reading: int) -> None:
    """Wait for the other process to end, and say why if it crashed."""
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        told = b""
        while part := os.read(reading, 4096):
            told += part
        found = _REASON.search(told)
        if found:
            reason = found[1].decode("ascii", "replace").lower()
            line = (
                f"trimotion: error: a library crashed ({reason}); if it was reading a file, "
                "convert that with another program first, and report it\n"
            )
            os.write(2, line.encode())
    finally:
        os._exit(0)
