"""A PNG of a stranger: only what makes the picture is kept of it, once that is known to be whole.

Decoders unpack texts and profiles as well, whose size no limit bounds, and draw what is missing
black. Source: PNG specification, third edition, sections 5.3, 8.1 and 11.2.
"""

import struct
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"
PARTS = frozenset({b"IHDR", b"PLTE", b"tRNS", b"IDAT", b"IEND"})
"""Kinds of chunks that a picture is made of."""
SAMPLES = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
"""Samples of a pixel by the type of colour."""
PALETTE = 3
WHOLE = ((0, 0, 1, 1),)
"""The one pass of a picture that is not interlaced: first column and row, and steps to the next."""
PASSES = (
    (0, 0, 8, 8),
    (4, 0, 8, 8),
    (0, 4, 4, 8),
    (2, 0, 4, 4),
    (0, 2, 2, 4),
    (1, 0, 2, 2),
    (0, 1, 1, 2),
)
"""Those of one that is (Adam7)."""


def picture_alone(png: bytes, most_across: int) -> bytes:
    """The chunks without which there is no picture.

    Args:
        png: Content of a file.
        most_across: Widest and highest picture [px].

    Raises:
        ValueError: If it is no PNG, too large, or damaged: check sums are wrong, or there are more
            or fewer rows than it says.
    """
    try:
        return _checked(png, most_across)
    except (struct.error, zlib.error, KeyError) as error:
        raise ValueError(f"damaged ({error})") from error


def _checked(png: bytes, most_across: int) -> bytes:
    if not png.startswith(SIGNATURE):
        raise ValueError("no PNG")
    at, kind = len(SIGNATURE), b""
    kept, found = [SIGNATURE], dict.fromkeys(PARTS, b"")
    while kind != b"IEND":
        length, kind = struct.unpack_from(">I4s", png, at)
        part = png[at : at + 12 + length]
        at += 12 + length
        if kind not in PARTS:
            continue
        (told,) = struct.unpack_from(">I", part, 8 + length)
        if zlib.crc32(part[4:-4]) != told:
            raise ValueError("a check sum is wrong")
        found[kind] += part[8:-4]
        kept.append(part)
    width, height, bits, color, *_, interlaced = struct.unpack(">IIBBBBB", found[b"IHDR"])
    if not (0 < width <= most_across and 0 < height <= most_across):
        raise ValueError("too large, or empty")
    if color == PALETTE and not found[b"PLTE"]:
        raise ValueError("no palette")
    expected = _bytes_of_rows(width, height, bits * SAMPLES[color], (WHOLE, PASSES)[interlaced > 0])
    zipped = zlib.decompressobj()
    rows = zipped.decompress(found[b"IDAT"], expected + 1)
    if len(rows) != expected or interlaced > 1:
        raise ValueError("rows are missing, or there are more than it says")
    return b"".join(kept)


def _bytes_of_rows(
    width: int, height: int, bits: int, passes: tuple[tuple[int, int, int, int], ...]
) -> int:
    """How long all rows are, each with the byte that says how it is told.

    Args:
        width: Of the picture [px].
        height: The same, down.
        bits: Of a pixel.
        passes: In which it is told.
    """
    length = 0
    for left, top, step_right, step_down in passes:
        columns, rows = -(-(width - left) // step_right), -(-(height - top) // step_down)
        if columns > 0:
            length += max(rows, 0) * (1 + (columns * bits + 7) // 8)
    return length
