"""Arrays as bytes: the same array, the same bytes, and back to the bit."""

import math
import zlib
from typing import Any

import numpy as np

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
        raise ValueError(f"{type(blob).__name__} instead of bytes")
    machine = zlib.decompressobj()
    try:
        content = machine.decompress(blob, size + 1)  # never more than is expected
    except zlib.error as error:
        raise ValueError(str(error)) from error
    if len(content) != size or not machine.eof:
        raise ValueError(f"{len(content)} bytes instead of {size}")
    planes = np.frombuffer(content, dtype=np.uint8).reshape(item, -1)
    return np.ascontiguousarray(planes.T).view(kind).reshape(shape)
