"""Boxes of ISO media files: a length, four letters, content.

Source: ISO/IEC 14496-12, Sec. 4.2 and 8.11.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

LARGEST = 2**26
"""Most bytes of a box that is read whole."""


@dataclass(frozen=True)
class Box:
    """One box."""

    kind: str
    """Its four letters."""
    content: bytes
    """What is inside, without length and letters."""

    @property
    def version(self) -> int:
        """Version of a full box."""
        return self.content[0]

    @property
    def flags(self) -> int:
        """Flags of a full box."""
        return int.from_bytes(self.content[1:4], "big")

    def children(self, skip: int = 0) -> Iterator["Box"]:
        """Boxes inside this one.

        Args:
            skip: Bytes before the first.
        """
        place = skip
        while place + 8 <= len(self.content):
            length, kind = struct.unpack_from(">I4s", self.content, place)
            begin = place + 8
            if length == 1:
                (length,) = struct.unpack_from(">Q", self.content, begin)
                begin += 8
            end = place + length if length else len(self.content)
            if end < begin or end > len(self.content):
                raise ValueError(f"a box {kind!r} of {length} bytes does not fit")
            yield Box(kind.decode("latin-1"), self.content[begin:end])
            place = end

    def child(self, kind: str, skip: int = 0) -> "Box | None":
        """The first box of a kind inside this one, or None.

        Args:
            kind: Its letters.
            skip: Bytes before the first.
        """
        return next((box for box in self.children(skip) if box.kind == kind), None)


class Reader:
    """Reads big-endian numbers one after the other."""

    def __init__(self, content: bytes, place: int = 0) -> None:
        """Start.

        Args:
            content: What is read.
            place: Where to begin.
        """
        self._content = content
        self._place = place

    def number(self, size: int) -> int:
        """A number without sign.

        Args:
            size: Its bytes; 0 gives 0.

        Raises:
            ValueError: If the content ends before.
        """
        return int.from_bytes(self.raw(size), "big")

    def raw(self, size: int) -> bytes:
        """Some bytes.

        Args:
            size: How many.

        Raises:
            ValueError: If the content ends before.
        """
        part = self._content[self._place : self._place + size]
        if len(part) < size:
            raise ValueError("a box ends too early")
        self._place += size
        return part


def top_boxes(path: Path, wanted: frozenset[str]) -> dict[str, Box]:
    """The first box of each kind at the top of a file; of the others only that they are there.

    Args:
        path: The file.
        wanted: Kinds whose content is read.

    Raises:
        OSError: If it cannot be read.
        ValueError: If a wanted box is too large.
    """
    found: dict[str, Box] = {}
    with path.open("rb") as file:
        size = path.stat().st_size
        place = 0
        while place + 8 <= size:
            file.seek(place)
            length, letters = struct.unpack(">I4s", file.read(8))
            kind, begin = letters.decode("latin-1"), place + 8
            if length == 1:
                (length,) = struct.unpack(">Q", file.read(8))
                begin += 8
            end = place + length if length else size
            if end < begin:
                break
            content = b""
            if kind in wanted and kind not in found:
                if end - begin > LARGEST:
                    raise ValueError(f"a box {kind!r} of {end - begin} bytes is too large")
                content = file.read(end - begin)
            found.setdefault(kind, Box(kind, content))
            place = end
    return found
