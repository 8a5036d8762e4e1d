"""Disks that become full: exit code 4, one line, the track whole and ready to go on."""

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from benchmarks.failures.films import QUICK, QUIET, content_of, done, is_one_line

MOMENTS = 10
"""At so many evenly spread fillings."""
PAGE = 4096
"""What such a disk is counted in [bytes]."""
ROOM = 1 << 26
"""A disk with room for everything [bytes]."""
SOLVE = ("solve", "film.mp4", "-o", "disk/a.mtrk", *QUICK, *QUIET)
RENDER = ("render", "film.mtrk", "-o", "disk/a.mkv", "--codec", "ffv1", *QUIET)


@contextmanager
def disk_of(folder: Path, size: int) -> Iterator[bool]:
    """Put a disk in memory into a folder while the block runs.

    Args:
        folder: Where.
        size: How large [bytes].

    Yields:
        Whether this user may do that here.
    """
    folder.mkdir(exist_ok=True)
    if shutil.which("mount") is None or not _mount("-t", "tmpfs", "-o", _sized(size), folder):
        yield False
        return
    try:
        yield True
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=True)


def resize(folder: Path, size: int) -> None:
    """Make a disk of `disk_of` larger or smaller.

    Args:
        folder: Where it is.
        size: How large [bytes].
    """
    assert _mount("-o", f"remount,{_sized(size)}", folder)


def full_disks(given: Path) -> Iterator[tuple[str, str]]:
    """Fill disks at several moments of solving and drawing.

    Args:
        given: A folder with `film.mp4` and `film.mtrk`.

    Yields:
        What was tried, and what is wrong; empty if nothing is.
    """
    with disk_of(given / "disk", ROOM) as may:
        if not may:
            yield "a disk in memory", "cannot be made by this user"
            return
        sizes = {}
        for words, name in ((SOLVE, "a.mtrk"), (RENDER, "a.mkv")):
            code, said = done(words, given)
            assert code == 0, said
            sizes[name] = (given / "disk" / name).stat().st_size
        drawn = content_of(given / "disk" / "a.mkv")
    for moment in range(MOMENTS):
        words, name = ((SOLVE, "a.mtrk"), (RENDER, "a.mkv"))[moment % 2]
        size = PAGE * max(2, int(sizes[name] / PAGE * (moment + 0.5) / MOMENTS))
        with disk_of(given / "disk", size):
            yield f"{name} on {size // 1024} KiB", _filled(given, words, name, drawn)


def _filled(given: Path, words: tuple[str, ...], name: str, drawn: str) -> str:
    """Fill one disk, make room, and go on; gives what is wrong."""
    output = given / "disk" / name
    code, said = done(words, given)
    if code != 4 or not is_one_line(said):
        return f"exit code {code}: {said}"
    if name == "a.mkv":
        if list(output.parent.iterdir()):
            return f"left {[path.name for path in output.parent.iterdir()]}"
    elif output.exists():
        code, said = done(("info", output), given)
        if code:
            return f"the track is damaged: {said}"
    resize(output.parent, ROOM)
    code, said = done((*words, "--resume" if name == "a.mtrk" else "--overwrite"), given)
    if code:
        return f"does not go on: {said}"
    wanted = content_of(given / "film.mtrk") if name == "a.mtrk" else drawn
    return "" if content_of(output) == wanted else "other bits after it went on"


def _mount(*words: object) -> bool:
    options, folder = words[:-1], words[-1]
    source = ["tmpfs"] if "-t" in options else []
    command = ["mount", *map(str, options), *source, str(folder)]
    return subprocess.run(command, check=False, capture_output=True).returncode == 0


def _sized(size: int) -> str:
    return f"size={size}"
