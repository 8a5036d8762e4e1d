"""What the compiler has read of Warp's headers, kept beside the compiled kernels.

To read them takes as long as to compile five kernels. Warp keeps what it has read until the
process ends, for each thread apart; here all threads and later processes take what one has read.
"""

import hashlib
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

import warp as wp

from warp_kernels.device.exact import CPU_FLAGS

PREFIX = "headers_"
"""How the name of the folder begins; the rest tells headers, compiler and processor."""
READ = "*.pch"
"""Files of the compiler with what it has read, named by Warp for the flags."""


def headers_are_read(folder: Path) -> bool:
    """Whether a thread or process before has left what it has read.

    Args:
        folder: Where compiled kernels are kept.
    """
    return any(_kept(folder).glob(READ))


@contextmanager
def shared_headers(folder: Path) -> Iterator[None]:
    """Lend what others have read to this thread, and keep what it reads in the block.

    Where that cannot be done the thread reads for itself.

    Args:
        folder: Where compiled kernels are kept.
    """
    before: dict[str, int] = {}
    kept = own = Path()
    with suppress(OSError, AttributeError, RuntimeError):
        kept, own = _kept(folder), _folder_of_thread()
        for path in kept.glob(READ):
            if not (own / path.name).exists():
                _lend(path, own / path.name)
        before = _ages(own)
    yield
    if own != kept:
        with suppress(OSError):
            for name, age in _ages(own).items():
                if before.get(name) != age:
                    _keep(own / name, kept / name)


@cache
def _kept(folder: Path) -> Path:
    """The folder for these headers, this compiler and this processor, there or not.

    A compiler refuses what was read from headers of another place or age.
    """
    headers = Path(wp.__file__).parent / "native"
    told = hashlib.sha256(wp.get_cpu_kernel_cache_key(cpu_compiler_flags=CPU_FLAGS).encode())
    for path in sorted(headers.rglob("*.h")):
        state = path.stat()
        told.update(f"{path} {state.st_size} {state.st_mtime_ns}".encode())
    return folder / (PREFIX + told.hexdigest()[:16])


def _folder_of_thread() -> Path:
    """Where Warp keeps what this thread has read."""
    return Path(wp._src.context.runtime.get_clang_pch_dir())


def _ages(folder: Path) -> dict[str, int]:
    """When each file was written; for one that was lent, when it was lent [ns]."""
    return {path.name: path.lstat().st_mtime_ns for path in folder.glob(READ)}


def _lend(kept: Path, own: Path) -> None:
    """Let a file be found in another folder."""
    try:
        own.symlink_to(kept)
    except OSError:  # a system or a user that may not
        shutil.copy(kept, own)


def _keep(own: Path, kept: Path) -> None:
    """Store a file for others, whole or not at all."""
    kept.parent.mkdir(parents=True, exist_ok=True)
    part = kept.with_name(f"{kept.name}.{os.getpid()}.part")
    try:
        shutil.copy(own, part)
        part.replace(kept)
    finally:
        part.unlink(missing_ok=True)
