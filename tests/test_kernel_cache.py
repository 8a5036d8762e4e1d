"""Compiled kernels find a place, or one line tells that there is none."""

import errno
import struct
import subprocess
import sys
from pathlib import Path

import pytest
import warp as wp
from test_encode import ROOT

from warp_kernels.device.compiling.whole_kernels import is_whole, remove_broken

SCRIPT = """
import sys, tempfile
import warp as wp
from warp_kernels.device.kernel_cache import settle_cache
from warp_kernels.errors import TrimotionError
if sys.argv[1:]:
    tempfile.tempdir = sys.argv[1]
try:
    print(*settle_cache())
    wp.init()
except TrimotionError as error:
    print("refused:", error)
print(wp.config.kernel_cache_dir)
"""


def settled(place: str | Path, *spare: str, before: str = "") -> list[str]:
    """What a process of its own says of a place, and where it stores kernels."""
    command = [sys.executable, "-c", before + SCRIPT, *spare]
    env = {"WARP_CACHE_PATH": str(place), "PATH": "/usr/bin:/bin", "HOME": str(Path.home())}
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, env=env)
    assert done.returncode == 0, done.stderr
    note, *_, place = done.stdout.splitlines()  # Warp tells of itself in between
    return [note, place]


def test_a_place_that_can_be_used_is(tmp_path: Path) -> None:
    """It is made if it is missing, and nothing is told."""
    note, place = settled(tmp_path / "new" / "cache")
    assert note == ""
    assert Path(place).is_relative_to(tmp_path / "new" / "cache")


@pytest.mark.parametrize("kind", ["file", "in a file", "no folder can be made", "full"])
def test_a_place_that_cannot_be_used(tmp_path: Path, kind: str) -> None:
    """A temporary one is taken, a note tells why, and it is gone afterwards."""
    (tmp_path / "file").write_text("")
    places = {
        "file": tmp_path / "file",
        "in a file": tmp_path / "file" / "cache",
        "no folder can be made": Path("/proc/cache"),
        "full": Path("/dev/full"),
    }
    if not places[kind].parent.exists() and kind != "in a file":
        pytest.skip("this system has no such place")
    note, place = settled(places[kind])
    assert "kept for this run only" in note
    assert "WARP_CACHE_PATH" in note
    assert "trimotion-kernels-" in place
    assert not Path(place).exists()


@pytest.mark.parametrize(
    ("code", "filled", "quiet"),
    [
        (errno.EROFS, True, True),
        (errno.EACCES, True, True),
        (errno.EROFS, False, False),
        (errno.ENOSPC, True, False),
    ],
)
def test_a_filled_place_that_is_closed_is_not_told_of(
    tmp_path: Path, code: int, filled: bool, quiet: bool
) -> None:
    """A read-only container is meant to be so; an empty place or a full disk is told every time."""
    if filled:
        (tmp_path / wp.config.version / "wp_solver").mkdir(parents=True)
    trial = f"""
import tempfile
opened = tempfile.TemporaryFile
def closed(dir):
    if str(dir).startswith({str(tmp_path)!r}):
        raise OSError({code}, "closed")
    return opened(dir=dir)
tempfile.TemporaryFile = closed
"""
    note, place = settled(tmp_path, before=trial)
    assert (note == "") == quiet
    assert "trimotion-kernels-" in place


def test_no_place_at_all_is_one_line(tmp_path: Path) -> None:
    """With the remedy."""
    (tmp_path / "file").write_text("")
    told, _ = settled(tmp_path / "file", str(tmp_path / "missing"))
    assert told.startswith("refused: compiled kernels cannot be stored")
    assert "WARP_CACHE_PATH" in told


def test_an_empty_name_is_none() -> None:
    """Warp would fill the current folder."""
    note, place = settled("")
    assert note == ""
    assert not Path(place).is_relative_to(ROOT)


def object_file(path: Path, size: int) -> Path:
    """An object file whose table of sections, two of 64 bytes, begins at byte 100."""
    header = bytearray(64)
    header[:5] = b"\x7fELF\x02"
    struct.pack_into("<Q", header, 40, 100)
    struct.pack_into("<HH", header, 58, 64, 2)
    path.parent.mkdir(exist_ok=True)
    path.write_bytes((bytes(header) + b"x" * 200)[:size])
    return path


def test_kernels_that_were_cut_off_are_removed(tmp_path: Path) -> None:
    """They are compiled again; whole ones, those of other systems and missing ones stay."""
    folders = [tmp_path / name for name in ("whole", "cut", "short", "zeros", "mach", "missing")]
    whole, cut, short, zeros, mach, _ = folders
    for folder, size in ((whole, 228), (cut, 227), (short, 20)):
        object_file(folder / "kernel.o", size)
    object_file(zeros / "kernel.o", 0).write_bytes(bytes(300))
    object_file(mach / "kernel.o", 0).write_bytes(b"\xcf\xfa\xed\xfe" * 30)
    assert [is_whole(folder) for folder in folders] == [True, False, False, False, True, True]
    remove_broken(folders, tmp_path, lambda: None)
    assert {folder.name for folder in folders if folder.exists()} == {"whole", "mach"}
