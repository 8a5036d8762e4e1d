"""Whether a file can come to a place, found out before any work is done."""

import os
from collections.abc import Iterable
from pathlib import Path

from stages.media.writing.commit import (
    PendingFile,
    output_error,
    refuse_special,
    remove_left_overs,
    true_place,
)
from warp_kernels.errors import OutputError


def check_name(path: Path) -> None:
    """Refuse places at which no file can be: nothing is written to find that out.

    Args:
        path: The file to be.

    Raises:
        OutputError: If no file can have its name, its folder is not there, or something else than
            a file stands there.
    """
    place = true_place(path)
    try:
        os.lstat(place)
    except (FileNotFoundError, NotADirectoryError):
        pass
    except (OSError, ValueError) as error:  # a name that no file can have
        raise output_error(path, error) from error
    if not place.parent.is_dir():
        raise OutputError(path, f"there is no folder {place.parent}", "create it first")
    if place.is_dir():
        raise OutputError(path, "is a folder", "give the name of a file")
    refuse_special(path)


def is_among(path: Path, others: Iterable[Path]) -> bool:
    """Whether a file is one of some others, whatever they are called.

    Args:
        path: The file.
        others: The others; a name that no file can have is that of none.
    """
    try:
        place = path.resolve()
    except (OSError, ValueError):  # a loop of links, or a null byte
        return False
    for other in others:
        try:
            if other.resolve() == place:
                return True
        except (OSError, ValueError):
            continue
    return False


def check_folder(path: Path) -> None:
    """Try whether its folder takes a file, and clear away what killed runs left there.

    Args:
        path: The file to be.

    Raises:
        OutputError: If the folder takes none.
    """
    remove_left_overs(true_place(path).parent)
    probe = PendingFile(path).path  # a name of this call's own: other threads try the folder, too
    try:
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise output_error(path, error) from error
