"""Small HEIF photos, written box by box: a grid of coded tiles, cropped and turned at will."""

import struct
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from media_samples import FLAGS

TILE = 64
"""Side of a tile [px]."""


def box(kind: str, *content: bytes) -> bytes:
    """A box."""
    inside = b"".join(content)
    return struct.pack(">I4s", len(inside) + 8, kind.encode()) + inside


def full(kind: str, *content: bytes, version: int = 0, flags: int = 0) -> bytes:
    """A box with a version and flags."""
    return box(kind, struct.pack(">I", version << 24 | flags), *content)


def coded(pixels: np.ndarray, folder: Path) -> tuple[bytes, bytes]:
    """A picture as HEVC: the box with its parameters, and its data."""
    path = folder / "tile.mp4"
    with av.open(str(path), "w") as output:
        stream = output.add_stream("libx265", rate=25)
        stream.height, stream.width = pixels.shape[:2]
        stream.pix_fmt = "yuv444p"
        stream.codec_context.options = {"x265-params": "log-level=none:crf=4:keyint=1"}
        stream.codec_context.color_range = 2
        stream.codec_context.colorspace = 5
        frame = av.VideoFrame.from_ndarray(pixels, format="rgb24").reformat(
            format="yuv444p",
            dst_colorspace="ITU601",
            src_color_range="JPEG",
            dst_color_range="JPEG",
            interpolation=FLAGS,
        )
        frame.pts, frame.time_base = 0, Fraction(1, 25)
        output.mux([*stream.encode(frame), *stream.encode(None)])
    content = path.read_bytes()
    place = content.index(b"hvcC") - 4
    (length,) = struct.unpack_from(">I", content, place)
    with av.open(str(path)) as source:
        data = b"".join(bytes(packet) for packet in source.demux(video=0))
    return content[place : place + length], data


def write_grid(
    path: Path,
    pixels: np.ndarray,
    *,
    properties: tuple[bytes, ...] = (),
    kept: int | None = None,
    thumbnail: bool = True,
) -> Path:
    """A photo cut into tiles of 64 px, the last ones padded, behind a thumbnail.

    Args:
        path: Where to write.
        pixels: The photo, [H, W, 3].
        properties: Boxes that crop and turn it, in order.
        kept: How many tiles are written; None for all.
        thumbnail: Whether the first picture in the file is a small grey one.
    """
    height, width = pixels.shape[:2]
    rows, columns = -(-height // TILE), -(-width // TILE)
    right, down = columns * TILE - width, rows * TILE - height
    padded = np.pad(pixels, ((0, down), (0, right), (0, 0)), mode="edge")
    pictures = [np.full((TILE, TILE, 3), 128, np.uint8)] if thumbnail else []
    for row in range(rows):
        for column in range(columns):
            tile = padded[row * TILE : (row + 1) * TILE, column * TILE : (column + 1) * TILE]
            pictures.append(np.ascontiguousarray(tile))
    parts = [coded(picture, path.parent) for picture in pictures]
    grid = struct.pack(">BBBBHH", 0, 0, rows - 1, columns - 1, width, height)
    tiles = list(range(2, 2 + len(pictures)))[1 if thumbnail else 0 :]
    present = tiles[:kept]
    head = box("ftyp", b"heic", bytes(4), b"mif1heic")
    known = (parts, grid, (width, height), properties, tiles, present, thumbnail)
    start = len(head) + len(_meta(*known, 0)) + 8
    data = b"".join(data for _, data in parts)
    path.write_bytes(head + _meta(*known, start) + box("mdat", data))
    return path


def _meta(parts, grid, size, properties, tiles, present, thumbnail, start) -> bytes:
    """The box that says how the photo is made; item 1 is the grid."""
    numbers = [1, *range(2, 2 + len(parts))]
    shown = [n for n in numbers if n not in tiles or n in present]
    infos = [
        full("infe", struct.pack(">HH4s", n, 0, b"grid" if n == 1 else b"hvc1"), b"\0", version=2)
        for n in shown
    ]
    listed = struct.pack(f">HH{len(tiles)}H", 1, len(tiles), *tiles)
    references = box("dimg", listed)
    if thumbnail:
        references += box("thmb", struct.pack(">HHH", 2, 1, 1))
    shared = [
        full("ispe", struct.pack(">II", *size)),
        full("ispe", struct.pack(">II", TILE, TILE)),
        parts[0][0],
        *properties,
    ]
    owned = struct.pack(">HB", 1, 1 + len(properties)) + bytes([1, *range(4, 4 + len(properties))])
    for number in shown[1:]:
        owned += struct.pack(">HBBB", number, 2, 2, 0x80 | 3)
    places = struct.pack(">BBH", 0x44, 0x40, len(shown))
    places += struct.pack(">HHHIHII", 1, 1, 0, 0, 1, 0, len(grid))
    for number in shown[1:]:
        before = sum(len(data) for _, data in parts[: number - 2])
        length = len(parts[number - 2][1])
        places += struct.pack(">HHHIHII", number, 0, 0, start, 1, before, length)
    return full(
        "meta",
        full("hdlr", bytes(4), b"pict", bytes(13)),
        full("pitm", struct.pack(">H", 1)),
        full("iinf", struct.pack(">H", len(shown)), *infos),
        full("iref", references),
        box("iprp", box("ipco", *shared), full("ipma", struct.pack(">I", len(shown)), owned)),
        full("iloc", places, version=1),
        box("idat", grid),
    )


def turn(angle: int) -> bytes:
    """A counter-clockwise turn [degrees]."""
    return box("irot", bytes([angle // 90]))


def mirror(axis: int) -> bytes:
    """1 exchanges left and right, 0 top and bottom."""
    return box("imir", bytes([axis]))


def crop(left: int, top: int, width: int, height: int, size: tuple[int, int]) -> bytes:
    """A part of the picture, stated from its middle."""
    right = 2 * left + width - size[0]
    down = 2 * top + height - size[1]
    return box("clap", struct.pack(">IIIIiIiI", width, 1, height, 1, right, 2, down, 2))
