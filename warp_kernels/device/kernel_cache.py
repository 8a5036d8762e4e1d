"""Where compiled kernels are kept: Warp's own place, or a temporary one if that cannot be used."""

import atexit
import errno
import os
import shutil
import tempfile
from functools import cache
from pathlib import Path

import warp as wp

from warp_kernels.device.cache_place import VARIABLE, cache_place
from warp_kernels.errors import TrimotionError

_ROOM = 8 * 2**20
"""Free space that the kernels of a run may take [bytes]."""

_MAY_NOT = {errno.EROFS, errno.EACCES, errno.EPERM}
"""What a place answers that was filled and then closed, as a container's is."""


@cache
def settle_cache() -> tuple[str, ...]:
    """Make sure that kernels can be stored, before Warp starts.

    Returns:
        One sentence if a temporary place had to be taken; it is removed when the process ends.
        Nothing is said of a place that is read-only by design: one that holds kernels, and that
        this user may not change.

    Raises:
        TrimotionError: If there is no place at all.
    """
    place = _usual_place()
    try:
        _try_to_write(place)
        if not wp.config.kernel_cache_dir:
            wp.config.kernel_cache_dir = str(place.parent)
        return ()
    except OSError as error:
        reason = str(error.strerror or error).lower()
        closed = error.errno in _MAY_NOT
    try:
        spare = Path(tempfile.mkdtemp(prefix="trimotion-kernels-"))
        atexit.register(shutil.rmtree, spare, ignore_errors=True)
        _try_to_write(spare / wp.config.version)
    except OSError as error:
        raise TrimotionError(
            f"compiled kernels cannot be stored in {place} ({reason}) nor in "
            f"{tempfile.gettempdir()}; name a folder with {VARIABLE}"
        ) from error
    shared = _share(place, spare / wp.config.version)
    os.environ[VARIABLE] = str(spare)
    wp.config.kernel_cache_dir = None
    if closed and shared:
        return ()
    return (
        f"compiled kernels cannot be stored in {place} ({reason}): they are kept for this run "
        f"only; {VARIABLE} names another folder",
    )


def _usual_place() -> Path:
    """Where Warp would store kernels."""
    if wp.config.kernel_cache_dir:
        return Path(wp.config.kernel_cache_dir)
    if not os.environ.get(VARIABLE):
        os.environ.pop(VARIABLE, None)  # Warp would take an empty name for the current folder
    return cache_place() / wp.config.version


def _try_to_write(place: Path) -> None:
    """Make a folder and see whether a file fits into it.

    Raises:
        OSError: If not.
    """
    place.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryFile(dir=place) as trial:
        trial.write(bytes(_ROOM))
        trial.flush()


def _share(place: Path, spare: Path) -> int:
    """Let what was compiled before be found in the temporary place; it is only read.

    Returns:
        How many kernels, and what else lies beside them, were found.
    """
    shared = 0
    try:
        for entry in place.iterdir():
            (spare / entry.name).symlink_to(entry.resolve())
            shared += 1
    except OSError:
        pass  # it is compiled again
    return shared
