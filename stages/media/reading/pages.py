"""Pages of a TIFF.

FFmpeg decodes the page that the head of the file points to, and does not tell of others.

Source: TIFF 6.0, Sec. 2.
"""

import struct
from pathlib import Path

_MOST = 65535
_KIND_OF_PAGE = 254
"""Tag whose lowest bit marks a smaller copy of another page."""
_ENTRY = 12
"""Bytes of an entry of a page's table."""


def pages_of(path: Path) -> list[int]:
    """Where the pages' tables begin; smaller copies of others do not count.

    Args:
        path: A TIFF; what of it is damaged is left out.
    """
    pages: list[int] = []
    seen: set[int] = set()
    try:
        with path.open("rb") as file:
            order = _order_of(file.read(4))
            (place,) = struct.unpack(order + "I", file.read(4))
            while place and place not in seen and len(seen) < _MOST:
                seen.add(place)
                file.seek(place)
                (count,) = struct.unpack(order + "H", file.read(2))
                table = file.read(count * _ENTRY)
                if not _is_copy(table, order):
                    pages.append(place)
                (place,) = struct.unpack(order + "I", file.read(4))
    except (OSError, struct.error):
        pass  # what can be decoded is decoded
    return pages


def with_page_first(path: Path, page: int) -> bytes:
    """The content of a TIFF whose head points to one of its pages.

    Args:
        path: The file.
        page: Where the page's table begins.
    """
    content = path.read_bytes()
    return content[:4] + struct.pack(_order_of(content) + "I", page) + content[8:]


def _order_of(head: bytes) -> str:
    return "<" if head[:2] == b"II" else ">"


def _is_copy(table: bytes, order: str) -> bool:
    for begin in range(0, len(table) - _ENTRY + 1, _ENTRY):
        tag, _, _, value = struct.unpack_from(order + "HHII", table, begin)
        if tag == _KIND_OF_PAGE:
            return bool(value & 1)
    return False
