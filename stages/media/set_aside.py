"""Frames that wait until they are needed again, within bounds of memory."""

import tempfile
from dataclasses import dataclass, replace
from io import BufferedRandom
from pathlib import Path
from typing import cast

import numpy as np

from stages.frame import Frame
from warp_kernels.errors import OutputError

ROOM = 1 << 30
"""Bytes of pictures that wait in memory: 388 frames of 720p, 43 of 2160p."""
_NO_PIXELS = np.empty((0, 0, 3), dtype=np.uint8)


class SetAside:
    """Sets frames aside: the first ones in memory, the others in a file without a name, of which
    nothing is left however the program ends.

    Args:
        room: Bytes of pictures that are kept in memory.
    """

    def __init__(self, room: int = ROOM) -> None:
        self._room, self._taken = room, 0
        self._file: BufferedRandom | None = None
        self._end = 0

    def put(self, frame: Frame) -> "AsideFrame":
        """Set a frame aside.

        Args:
            frame: The frame; whoever lets go of it frees its pictures, unless there is room.

        Raises:
            OutputError: If the file cannot be written.
        """
        pictures = [frame.pixels] if frame.weights is None else [frame.pixels, frame.weights]
        size = sum(picture.nbytes for picture in pictures)
        if self._taken + size <= self._room:
            self._taken += size
            return AsideFrame(frame, self, ())
        places = tuple(_Place(self._written(one), one.shape) for one in pictures)
        return AsideFrame(replace(frame, pixels=_NO_PIXELS, weights=None), self, places)

    def clear(self) -> None:
        """Forget all frames; the next ones take their room."""
        self._taken = self._end = 0
        if self._file is not None:
            self._file.close()
            self._file = None

    def read(self, place: "_Place") -> np.ndarray:
        """A picture of the file, uint8.

        Args:
            place: Where it lies.

        Raises:
            OutputError: If it cannot be read back.
        """
        assert self._file is not None
        picture = np.empty(place.shape, dtype=np.uint8)
        try:
            self._file.seek(place.begin)
            if self._file.readinto(picture.data) != picture.nbytes:
                raise OSError("it is shorter than what was written")
        except OSError as error:
            raise _failure(error) from error
        return picture

    def _written(self, picture: np.ndarray) -> int:
        """Write a picture to the end of the file; where it begins there."""
        begin = self._end
        try:
            if self._file is None:
                self._file = _nameless_file()
            self._file.seek(begin)
            self._file.write(np.ascontiguousarray(picture).data)
            self._file.flush()
        except OSError as error:
            raise _failure(error) from error
        self._end += picture.nbytes
        return begin


@dataclass(frozen=True, slots=True)
class _Place:
    """Where a picture lies in the file."""

    begin: int
    """Its first byte."""
    shape: tuple[int, ...]
    """[H, W, 3] or [H, W]."""


@dataclass(frozen=True, eq=False, slots=True)
class AsideFrame:
    """A frame that was set aside."""

    _frame: Frame
    _store: SetAside
    _places: tuple[_Place, ...]

    def frame(self) -> Frame:
        """The frame, with the pictures that it had.

        Raises:
            OutputError: If they cannot be read back.
        """
        if not self._places:
            return self._frame
        pixels, *weights = map(self._store.read, self._places)
        return replace(self._frame, pixels=pixels, weights=weights[0] if weights else None)


def _nameless_file() -> BufferedRandom:
    """A file that is gone when it is closed, which `SetAside.clear` does."""
    file = tempfile.TemporaryFile(prefix="trimotion-")  # noqa: SIM115
    return cast(BufferedRandom, file)


def _failure(error: OSError) -> OutputError:
    """What to tell where pictures cannot wait in a file."""
    reason = str(error.strerror or error).lower()
    try:
        folder = tempfile.gettempdir()
    except OSError:
        folder = "TMPDIR"
    return OutputError(
        Path(folder),
        f"pictures that wait for an edited frame cannot be kept there ({reason})",
        "free space in it, or name a larger folder as TMPDIR",
    )
