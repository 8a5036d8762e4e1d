"""Whole numbers as bytes: few, where most are small.

The first byte says how many bytes a number takes. These bytes follow in planes, those of equal
weight side by side, the lowest first; before them stands how long each plane is, in four bytes. A
plane as long as there are numbers stands there as it is, for the lowest bytes are noise that only
takes time to unpack; others are deflated. No blob of `plain.pack` begins so: those begin as all of
zlib do.
"""

import zlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from pipeline.track.nouns import noun_for
from pipeline.track.packing.plain import LEVEL

WIDEST = 7
"""Most bytes of a number: sums of a few of them are numbers of 64 bits."""
LENGTH = 4
"""Bytes that tell the length of a plane."""
WORTH = 0.97
"""Planes that shrink by less are told as they are."""
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
    planes = [plain.view(np.uint8)[place::8].tobytes() for place in range(width)]
    packed = [zlib.compress(plane, LEVEL) for plane in planes]
    told = [p if len(p) < WORTH * len(q) else q for p, q in zip(packed, planes, strict=True)]
    lengths = b"".join(len(plane).to_bytes(LENGTH, "little") for plane in told)
    return b"".join([bytes([width]), lengths, *told])


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
    planes = list(_planes(blob, width, count))
    numbers = planes[-1].view(np.int8).astype(np.int32 if width <= 4 else np.int64)
    for plane in planes[-2::-1]:
        np.left_shift(numbers, 8, out=numbers)
        np.bitwise_or(numbers, plane, out=numbers)
    return numbers.reshape(shape)


def _planes(blob: bytes, width: int, count: int) -> Iterator[np.ndarray]:
    """Bytes of equal weight, the lowest ones first, each [N] uint8."""
    start = 1 + LENGTH * width
    for place in range(width):
        head = 1 + LENGTH * place
        end = start + int.from_bytes(blob[head : head + LENGTH], "little")
        plane: memoryview | bytes = memoryview(blob)[start:end]
        if end - start != count:
            machine = zlib.decompressobj()
            try:
                plane = machine.decompress(plane, count + 1)
            except zlib.error as error:
                raise ValueError(str(error)) from error
        if len(plane) != count:
            raise ValueError(f"{len(plane)} bytes instead of {count}")
        yield np.frombuffer(plane, dtype=np.uint8)
        start = end
    if start != len(blob):
        raise ValueError(f"{len(blob)} bytes instead of {start}")
