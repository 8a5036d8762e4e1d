"""The folder that outputs go to, made if it is not there."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from warp_kernels.errors import OutputError


@contextmanager
def output_folder(folder: Path | None) -> Iterator[None]:
    """Make a folder for what the block writes; if nothing comes of it, none is left.

    Args:
        folder: The folder; those above it are made, too. None if none is to be made.

    Raises:
        OutputError: If it cannot be made.
    """
    if folder is None:
        yield
        return
    missing = [place for place in (folder, *folder.parents) if not os.path.exists(place)]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = str(getattr(error, "strerror", None) or error).lower()
        raise OutputError(folder, f"cannot be made ({reason})", "choose another folder") from error
    try:
        yield
    finally:
        for place in missing:
            try:
                place.rmdir()
            except OSError:  # holds something
                break
