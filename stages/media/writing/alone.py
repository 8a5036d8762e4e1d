"""One run at a time writes to an output: the second one says so, and breaks nothing.

A lock of the system on a hidden file beside the output, which dies with the process that holds it.
"""

import hashlib
import os
import platform
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import IO

from stages.media.naming import NumberedPattern
from stages.media.writing.commit import true_place
from warp_kernels.device.file_lock import locked
from warp_kernels.errors import OptionError, OutputError

_MOMENT = 0.1
"""How often a lock that others hold is tried again [s]."""


@contextmanager
def alone(*outputs: Path | None, patience: float = 0.0) -> Iterator[None]:
    """Keep other runs from writing to some outputs while the block runs.

    Numbered stills are not kept: each of them appears whole, and several machines may draw one
    film. Neither are devices, nor what lies where no file can be made; whoever writes there says
    what is wrong.

    Args:
        outputs: Their names; None is none.
        patience: How long to wait for another run [s].

    Raises:
        OutputError: If another run writes to one.
    """
    with ExitStack() as stack:
        for place in sorted({lock for output in outputs if (lock := _lock_of(output))}):
            file = _taken(place, patience)
            if file is not None:
                stack.callback(_give_back, place[0], file)
        yield


def _lock_of(output: Path | None) -> tuple[Path, Path] | None:
    """The file that is locked for an output, and the output; None if nothing is."""
    if output is None:
        return None
    with suppress(OptionError, OSError, ValueError):
        target = true_place(output)
        if target.exists() and not target.is_file():
            return None
        if NumberedPattern.parse(output) is not None and not target.is_file():
            return None
        folder = target.parent.resolve()
        name = hashlib.sha256(os.fsencode(target.name)).hexdigest()[:16]
        return folder / f".trimotion-{name}.lock", output
    return None


def _taken(place: tuple[Path, Path], patience: float) -> IO[bytes] | None:
    """Lock an output, or find that this cannot be done where it lies."""
    path, output = place
    end = time.monotonic() + patience
    while True:
        try:
            file = path.open("a+b")
        except OSError:
            return None
        if locked(file):
            if _is_still(path, file):
                file.truncate(0)
                file.write(f"process {os.getpid()} on {platform.node()}".encode())
                file.flush()
                return file
        elif time.monotonic() >= end:
            with file:
                file.seek(0)
                owner = file.read(200).decode(errors="replace") or "a process"
            told = "".join(letter if letter.isprintable() else "?" for letter in owner)
            raise OutputError(
                output,
                f"another run is writing it ({told})",
                "wait until that has ended, or choose another name",
            )
        else:
            time.sleep(_MOMENT)
        file.close()


def _is_still(path: Path, file: IO[bytes]) -> bool:
    """Whether a file that was locked has its name yet: another run may have removed it before."""
    try:
        return os.path.samestat(path.stat(), os.fstat(file.fileno()))
    except OSError:
        return False


def _give_back(path: Path, file: IO[bytes]) -> None:
    """Remove a lock, in this order: whoever opened it meanwhile finds it gone, and tries again."""
    with suppress(OSError):
        path.unlink()
    file.close()
    if os.name != "posix":  # where no open file can be removed
        with suppress(OSError):
            path.unlink()
