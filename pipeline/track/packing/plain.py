"""Arrays as bytes: the same array, the same bytes, and back to the bit."""

import math
import zlib
from typing import Any

import numpy as np

from pipeline.track.nouns import noun_for

LEVEL = 1
"""zlib's fastest level: stronger ones save a few percent and cost several times as much."""


def pack(array: np.ndarray, kind: str) -> bytes:
    """Pack an array: bytes of equal weight side by side, which zlib packs best, then zlib.

    Args:
        array: Any shape.
        kind: Little-endian type that is stored, such as `<f8`.
    """
    plain = np.ascontiguousarray(array, dtype=kind)
    planes = plain.reshape(-1).view(np.uint8).reshape(-1, plain.itemsize).T
    return zlib.compress(planes.tobytes(), LEVEL)


def unpack_rows(blob: Any, kind: str, width: int, most: int) -> np.ndarray:
    """Unpack an array of which only the number of columns is known.

    Args:
        blob: What `pack` gave, if the file was not tampered with.
        kind: Its type.
        width: Its columns.
        most: Most rows that it may have.

    Raises:
        ValueError: If the bytes are damaged or too many.

    Returns:
        Shape [N, width].
    """
    row = np.dtype(kind).itemsize * width
    if not isinstance(blob, bytes):
        raise ValueError(f"{noun_for(blob)} instead of bytes")
    machine = zlib.decompressobj()
    try:
        size = len(machine.decompress(blob, most * row + 1))
    except zlib.error as error:
        raise ValueError(str(error)) from error
    if size % row or size > most * row:
        raise ValueError(f"{size} bytes of rows of {row}")
    return unpack(blob, kind, (size // row, width))


def unpack(blob: Any, kind: str, shape: tuple[int, ...]) -> np.ndarray:
    """Unpack an array.

    Args:
        blob: What `pack` gave, if the file was not tampered with.
        kind: Its type.
        shape: Its shape.

    Raises:
        ValueError: If the bytes are damaged or of another size.
    """
    item = np.dtype(kind).itemsize
    size = math.prod(shape) * item
    if not isinstance(blob, bytes):
        raise ValueError(f"{noun_for(blob)} instead of bytes")
    machine = zlib.decompressobj()
    try:
        content = machine.decompress(blob, size + 1)  # never more than is expected
    except zlib.error as error:
        raise ValueError(str(error)) from error
    if len(content) != size or not machine.eof:
        raise ValueError(f"{len(content)} bytes instead of {size}")
    planes = np.frombuffer(content, dtype=np.uint8).reshape(item, -1)
    return np.ascontiguousarray(planes.T).view(kind).reshape(shape)
