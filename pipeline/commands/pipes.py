"""`-` for a source or an output: standard input and standard output, by way of temporary files.

Most formats must be read and written out of order, which a pipe cannot be.
"""

import argparse
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from warp_kernels.errors import MediaError, OptionError

PIPE = "-"
"""How a user names a pipe; `-.gif` and the like choose the format of an output."""
FORMATS = {"solve": ".mtrk", "join": ".mtrk"}
"""Ending of an output whose name does not say, by the command; Matroska for the others."""
_MADE = "standard output"


@contextmanager
def piped(arguments: argparse.Namespace) -> Iterator[None]:
    """Put files in place of pipes while a command runs, and send an output on after it.

    Args:
        arguments: What the user gave; names of pipes are replaced.

    Raises:
        MediaError: If nothing comes through the pipe.
        OptionError: If standard output is asked for twice.
    """
    given = vars(arguments)
    inputs = [key for key in ("source", "file") if given.get(key) == PIPE]
    output = given.get("output") or ""
    writes = output == PIPE or (output.startswith("-.") and "/" not in output)
    if not inputs and not writes:
        yield
        return
    if writes and given.get("progress") == "json":
        raise OptionError("-o -: standard output is taken by --progress json; choose another")
    with tempfile.TemporaryDirectory(prefix="trimotion-") as folder:
        for key in inputs:
            setattr(arguments, key, str(_received(Path(folder) / "standard input")))
        ending = output[1:] or FORMATS.get(arguments.command, ".mkv")
        made = Path(folder) / f"{_MADE}{ending}"
        if writes:
            arguments.output = str(made)
        yield
        if writes:
            with made.open("rb") as file:
                shutil.copyfileobj(file, sys.stdout.buffer)
            sys.stdout.buffer.flush()


def shown_name(path: Path) -> Path:
    """What a user calls an output.

    Args:
        path: The file that is written.
    """
    return Path(PIPE) if path.stem == _MADE else path


def _received(path: Path) -> Path:
    """All that comes through standard input, as a file."""
    if sys.stdin is None or sys.stdin.isatty():
        raise MediaError(PIPE, "nothing is piped in", "write trimotion ... - < FILE")
    with path.open("wb") as file:
        shutil.copyfileobj(sys.stdin.buffer, file)
    return path
