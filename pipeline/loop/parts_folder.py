"""Where the tracks of ranges lie until they are joined: a folder beside the whole one."""

import shutil
from collections.abc import Iterable
from pathlib import Path

from pipeline.loop.ranges import Part
from pipeline.options.output import Output
from pipeline.track.schema import ENDING
from stages.media import FrameRange
from warp_kernels.errors import OutputError


def folder_of(track: Path) -> Path:
    """The folder of the parts of a track.

    Args:
        track: The whole one.
    """
    return track.with_name(f"{track.name}.parts")


def parts_of(ranges: Iterable[FrameRange], track: Path) -> list[Part]:
    """Ranges and their tracks; these go on with what an interrupted run left.

    Args:
        ranges: The ranges.
        track: The whole track.
    """
    folder = folder_of(track)
    return [Part(r, Output(track=folder / f"{r}{ENDING}", resume=True)) for r in ranges]


def make_folder(track: Path, *, resume: bool, overwrite: bool) -> None:
    """Make the folder of the parts, or take what an interrupted run left in it.

    Args:
        track: The whole track.
        resume: Whether to go on with what is there.
        overwrite: Whether what is there may be replaced.

    Raises:
        OutputError: If it cannot be made, or holds parts that are neither wanted nor replaced.
    """
    folder = folder_of(track)
    if folder.exists() and not resume:
        if not overwrite:
            raise OutputError(
                folder, "holds parts of an interrupted job", "--resume that, or --overwrite it"
            )
        remove_folder(track)
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        reason = str(error.strerror or error).lower()
        raise OutputError(folder, f"cannot be made ({reason})", "check the folder") from error


def remove_folder(track: Path) -> None:
    """Remove the folder of the parts, if there is one.

    Args:
        track: The whole track.
    """
    shutil.rmtree(folder_of(track), ignore_errors=True)
