"""Whole numbers as bytes: few, where most are small.

The first byte says how many bytes a number takes; the rest are these bytes, those of equal weight
side by side, deflated. No blob of `plain.pack` begins so: those begin as all of zlib do.
"""

import zlib
from typing import Any

import numpy as np

from pipeline.track.nouns import noun_for
from pipeline.track.packing.plain import LEVEL

WIDEST = 7
"""Most bytes of a number: sums of a few of them are numbers of 64 bits."""
ZLIB = 0x78
"""How all of zlib begins."""


def pack_whole(numbers: np.ndarray) -> bytes | None:
    """Pack numbers of any sign.

    Args:
        numbers: Whole numbers of any type, any shape.

    Returns:
        None if one is too large.
    """
    plain = np.ascontiguousarray(numbers, dtype="<i8").reshape(-1)
    largest = max(int(plain.max(initial=0)), ~int(plain.min(initial=0)))
    width = largest.bit_length() // 8 + 1
    if width > WIDEST:
        return None
    planes = plain.view(np.uint8).reshape(-1, 8)[:, :width].T
    return bytes([width]) + zlib.compress(planes.tobytes(), LEVEL)


def is_whole(blob: Any) -> bool:
    """Whether a blob is what `pack_whole` gives, rather than one of `plain.pack`."""
    return isinstance(blob, bytes) and len(blob) > 0 and blob[0] != ZLIB


def unpack_whole(blob: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Unpack numbers.

    Args:
        blob: What `pack_whole` gave, if the file was not tampered with.
        shape: Their shape.

    Raises:
        ValueError: If the bytes are damaged or of another size.

    Returns:
        int32 or int64.
    """
    if not isinstance(blob, bytes) or not blob:
        raise ValueError(f"{noun_for(blob)} instead of bytes")
    width, count = blob[0], int(np.prod(shape, dtype=np.int64))
    if not 1 <= width <= WIDEST:
        raise ValueError(f"numbers of {width} bytes")
    machine = zlib.decompressobj()
    try:
        content = machine.decompress(memoryview(blob)[1:], width * count + 1)
    except zlib.error as error:
        raise ValueError(str(error)) from error
    if len(content) != width * count or not machine.eof:
        raise ValueError(f"{len(content)} bytes instead of {width * count}")
    planes = np.frombuffer(content, dtype=np.uint8).reshape(width, count)
    numbers = planes[-1].view(np.int8).astype(np.int32 if width <= 4 else np.int64)
    for plane in planes[-2::-1]:
        numbers <<= 8
        numbers |= plane
    return numbers.reshape(shape)
