"""Pictures in edits are what their files are, or are refused; nothing else of them is unpacked."""

import struct
import zlib
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from pipeline.edit_log.painted_regions import check_style
from stages.hand.regions.texture_region import TextureRegion
from stages.masks.gray import read_gray
from stages.media.embedded import MOST_ACROSS, embedded, read_embedded
from stages.media.png_parts import picture_alone
from warp_kernels.errors import OptionError

MODES = ("L", "LA", "RGB", "RGBA", "P", "1")


def png_of(mode: str, size: tuple[int, int] = (21, 13), **options: Any) -> bytes:
    """A PNG of noise."""
    pixels = np.random.default_rng(4).integers(0, 256, (size[1], size[0], 4), dtype=np.uint8)
    made = BytesIO()
    Image.fromarray(pixels, "RGBA").convert(mode).save(made, "png", **options)
    return made.getvalue()


def chunk(kind: bytes, content: bytes) -> bytes:
    """A chunk with its check sum."""
    told = struct.pack(">I", zlib.crc32(kind + content))
    return struct.pack(">I", len(content)) + kind + content + told


def with_header(png: bytes, **changed: int) -> bytes:
    """Another header before the same rows."""
    names = ("width", "height", "bits", "color", "packing", "filter", "interlaced")
    values = dict(zip(names, struct.unpack(">IIBBBBB", png[16:29]), strict=True)) | changed
    return png[:8] + chunk(b"IHDR", struct.pack(">IIBBBBB", *values.values())) + png[33:]


@pytest.mark.parametrize("mode", MODES)
def test_a_picture_is_what_its_file_is(mode: str, tmp_path: Path) -> None:
    """Over white where it is transparent, too."""
    png = png_of(mode, **({"transparency": 7} if mode == "P" else {}))
    file = tmp_path / "one.png"
    file.write_bytes(png)
    np.testing.assert_array_equal(read_gray(embedded(png)), read_gray(str(file)))


def test_a_picture_told_in_passes_is_the_same() -> None:
    """Small ones lack some of the seven passes."""
    for size in ((3, 2), (1, 9), (21, 13)):
        rows = np.random.default_rng(1).integers(0, 256, size[::-1], dtype=np.uint8)
        packed = b""
        for x, y, right, down in (
            *((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8)),
            *((2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)),
        ):
            part = rows[y::down, x::right]
            packed += b"".join(b"\0" + row.tobytes() for row in part) if part.size else b""
        png = png_of("L", size)[:8] + chunk(b"IHDR", struct.pack(">IIBBBBB", *size, 8, 0, 0, 0, 1))
        png += chunk(b"IDAT", zlib.compress(packed)) + chunk(b"IEND", b"")
        np.testing.assert_array_equal(read_embedded(embedded(png))[..., 0], rows)


def test_texts_and_profiles_are_not_unpacked() -> None:
    """They may hold a thousand times what they take, and a decoder kept all of it."""
    png = png_of("RGB")
    large = zlib.compress(bytes(1 << 20))
    extra = chunk(b"zTXt", b"k\0\0" + large) + chunk(b"iCCP", b"k\0\0" + large)
    assert picture_alone(png[:33] + extra + png[33:], MOST_ACROSS) == png
    assert read_embedded(embedded(png)).base is None  # not a part of what a decoder holds


@pytest.mark.parametrize(
    "broken",
    [
        b"",
        png_of("RGB")[:-30],
        png_of("RGB").replace(b"IDAT", b"IDAU"),
        png_of("P").replace(b"PLTE", b"pLTE"),
        png_of("RGB")[:-14] + b"\1\1" + png_of("RGB")[-12:],
        with_header(png_of("RGB"), width=22),
        with_header(png_of("RGB"), width=7),
        with_header(png_of("RGB"), height=14),
        with_header(png_of("RGB"), height=12),
        with_header(png_of("RGB"), height=0),
        with_header(png_of("RGB"), color=5),
        with_header(png_of("RGB"), interlaced=1),
        with_header(png_of("RGB"), interlaced=9),
        with_header(png_of("RGB"), width=1 << 31),
        png_of("L", (MOST_ACROSS + 1, 1)),
        png_of("L")[:33] + chunk(b"IDAT", zlib.compress(bytes(1 << 24))) + chunk(b"IEND", b""),
    ],
)
def test_what_is_not_whole_is_refused(broken: bytes) -> None:
    """Half of a picture would be drawn black."""
    with pytest.raises(OptionError, match="no PNG of at most"):
        read_embedded(embedded(broken))


def test_a_long_text_is_told_as_such() -> None:
    noise = np.random.default_rng(2).bytes(1 << 20)
    with pytest.raises(OptionError, match="letters"):
        read_embedded(embedded(noise))


@pytest.mark.parametrize("text", ["DATA:image/png;base64,AAAA", "data:image/jpeg;base64,AAAA"])
def test_what_holds_a_picture_of_another_kind_is_no_name(text: str) -> None:
    """Its letters are not told whole, as those of a name are."""
    square = ((0.0, 0.0), (9.0, 0.0), (9.0, 9.0))
    with pytest.raises(OptionError, match="begins with data:image/png;base64,") as told:
        check_style(TextureRegion(frame=0, polygon=square, file=text + "A" * 500))
    assert len(str(told.value)) < 200
