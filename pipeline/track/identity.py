"""Whether a source is still the one that a track was made from."""

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

from stages.media import input_pattern
from warp_kernels.errors import MediaError, TrackError

SAMPLE = 1 << 20
"""Bytes at a file's beginning and end that tell it from others; a film is not read as a whole."""
PIPE = "-"
"""Where a source was that came through standard input."""


@dataclass(frozen=True)
class SourceIdentity:
    """What tells a source from others, wherever it lies."""

    path: str
    """Where it was, absolute, or whence it came, see `is_file`; this may change."""
    size: int
    """Size of all its files [bytes]."""
    digest: str
    """SHA-256 of the sizes, the first and the last mebibyte of its files."""

    @property
    def is_file(self) -> bool:
        """Whether it lay in files; else it came from an address or through the pipe `-`."""
        return os.path.isabs(self.path) or not (self.path == PIPE or "://" in self.path)

    @property
    def remedy(self) -> str:
        """What to do where it is needed and not there."""
        if self.is_file:
            return "say with --source where it is"
        what = "what was piped in" if self.path == PIPE else "it"
        return f"save {what} to a file and say with --source where that is"

    def check(self, path: Path) -> None:
        """Refuse another source.

        Args:
            path: The source that is to be used.

        Raises:
            MediaError: If it cannot be read.
            TrackError: If it is not the one.
        """
        found = identity_of(path)
        if (found.size, found.digest) != (self.size, self.digest):
            what = (
                f"{found.size} bytes, it had {self.size}"
                if found.size != self.size
                else "the same size, another content"
            )
            raise TrackError(
                f"{path}: is not the source that the track was made from ({what}); name that "
                "one, or solve again"
            )


def identity_of(path: Path) -> SourceIdentity:
    """What tells a source from others.

    Args:
        path: A file or a pattern of numbered stills.

    Raises:
        MediaError: If it cannot be read.
    """
    pattern = input_pattern(path)
    numbers = pattern.numbers() if pattern is not None else []
    files = [pattern.path_for(n) for n in numbers] if pattern is not None else [path]
    digest = hashlib.sha256()
    total = 0
    try:
        for file in files:
            size = file.stat().st_size
            total += size
            digest.update(f"{size};".encode())
            digest.update(_ends(file, size))
    except OSError as error:
        reason = str(error.strerror or error).lower()
        raise MediaError(path, f"cannot be read ({reason})", "check the name") from error
    return SourceIdentity(str(path.absolute()), total, digest.hexdigest())


def _ends(path: Path, size: int) -> bytes:
    """Beginning and end of a file."""
    with path.open("rb") as file:
        head = file.read(SAMPLE)
        file.seek(max(SAMPLE, size - SAMPLE))
        return head + file.read(SAMPLE)
