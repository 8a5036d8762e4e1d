"""Folders, sources and clocks that change while a run works, and machines that lack something."""

import os
import shutil
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from benchmarks.failures.disks import disk_of
from benchmarks.failures.films import (
    QUICK,
    QUIET,
    content_of,
    done,
    ended,
    is_one_line,
    start,
    write_film,
)

SOLVE = ("solve", "film.mp4", "-o", "out/a.mtrk", *QUICK, *QUIET)
ANIMATE = ("animate", "film.mp4", "-o", "out/a.mkv", "--codec", "ffv1", *QUICK, *QUIET)
CLOCK = """
import time
_begun, _monotonic = time.time(), time.monotonic
time.time = lambda: _begun - 86400.0 * (_monotonic() % 7)
"""
"""A clock that jumps to and fro by days, as a `sitecustomize` of a run."""


def places(given: Path) -> Iterator[tuple[str, str]]:
    """Try each of them.

    Args:
        given: A folder with `film.mp4` and `film.mtrk`.

    Yields:
        What was tried, and what is wrong; empty if nothing is.
    """
    for words in (SOLVE, ANIMATE):
        for name, change in CHANGES.items():
            yield f"{words[0]}: {name}", changed(given, words, change)
    wanted = content_of(given / "film.mtrk")
    for name, env in _machines(given).items():
        yield f"solve: {name}", _solved(given, env, wanted)
    with disk_of(given / "small", 8192) as may:
        if may:
            yield "solve: no space in /tmp", _solved(given, _temporary(given / "small"), wanted)
    os.chmod(given / "locked", 0o700)


def changed(given: Path, words: tuple[str, ...], change: Callable[[Path], None]) -> str:
    """Change something in the middle of a run; gives what is wrong."""
    folder = given.parent / "changed"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy(given / "film.mp4", folder)
    (folder / "out").mkdir()
    process = start(words, folder)
    while not _has_begun(folder / "out") and process.poll() is None:
        time.sleep(0.02)
    change(folder)
    code, said = ended(process)
    if code not in (0, 3, 4) or (code and not is_one_line(said)):
        return f"exit code {code}: {said}"
    made = list((folder / "out").glob("a.*")) if (folder / "out").exists() else []
    if code == 0 and not made:
        return "says that all is well, and nothing is there"
    for path in made:
        content_of(path)
    return ""


def _has_begun(folder: Path) -> bool:
    return any(path.suffix in (".part", ".mtrk") for path in folder.iterdir())


def _remove_folder(folder: Path) -> None:
    shutil.rmtree(folder / "out")


def _truncate(folder: Path) -> None:
    os.truncate(folder / "film.mp4", (folder / "film.mp4").stat().st_size // 2)


def _empty(folder: Path) -> None:
    os.truncate(folder / "film.mp4", 0)


def _replace(folder: Path) -> None:
    write_film(folder / "other.mp4")
    content = bytearray((folder / "other.mp4").read_bytes())
    content[len(content) // 3 : len(content) // 2] = bytes(len(content) // 2 - len(content) // 3)
    (folder / "film.mp4").write_bytes(content)


def _remove_source(folder: Path) -> None:
    (folder / "film.mp4").unlink()


CHANGES: Mapping[str, Callable[[Path], None]] = {
    "output folder removed": _remove_folder,
    "source cut to half": _truncate,
    "source emptied": _empty,
    "source replaced": _replace,
    "source removed": _remove_source,
}
"""What happens to files while they are worked with."""


def _machines(given: Path) -> dict[str, dict[str, str | None]]:
    """Variables of the environment of machines that lack something."""
    clock = given / "clock"
    clock.mkdir(exist_ok=True)
    (clock / "sitecustomize.py").write_text(CLOCK)
    root = str(Path(__file__).parents[2])
    locked = given / "locked"
    locked.mkdir(exist_ok=True)
    locked.chmod(0o500)
    a_file = given / "file"
    a_file.touch()
    return {
        "clock set back": {"PYTHONPATH": f"{clock}{os.pathsep}{root}"},
        "no HOME": {"HOME": None, "XDG_CACHE_HOME": None},
        "HOME is nowhere": {"HOME": "/nonexistent", "XDG_CACHE_HOME": None},
        "no folder for temporary files": _temporary(given / "nowhere"),
        "the kernels' folder is a file": {"WARP_CACHE_PATH": str(a_file)},
        "the kernels' folder is read-only": {"WARP_CACHE_PATH": str(locked)},
    }


def _temporary(folder: Path) -> dict[str, str | None]:
    return dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder))


def _solved(given: Path, env: Mapping[str, str | None], wanted: str) -> str:
    """Solve on such a machine; gives what is wrong."""
    track = given / "machine.mtrk"
    track.unlink(missing_ok=True)
    code, said = done(("solve", "film.mp4", "-o", track.name, *QUICK, *QUIET), given, env)
    if code in (1, 4) and is_one_line(said) and "internal error" not in said:
        return "" if not track.exists() else f"left a track: {said}"
    if code:
        return f"exit code {code}: {said}"
    return "" if content_of(track) == wanted else "other bits"
