"""Presets and lists of cuts as editors of all systems write them."""

import codecs
from pathlib import Path

import pytest

from pipeline.options.presets import read_preset
from pipeline.track.cuts import read_cuts
from stages.media.text_file import bounded_bytes
from warp_kernels.errors import MediaError, OptionError

ENCODINGS = {
    "utf-8": "utf-8",
    "utf-8 with mark": "utf-8-sig",
    "utf-16 with mark": "utf-16",
    "utf-16-le": "utf-16-le",
    "utf-16-be": "utf-16-be",
    "utf-32": "utf-32",
}


def written(path: Path, text: str, encoding: str, end: str) -> Path:
    """A text with its encoding and its ends of lines."""
    path.write_bytes(text.replace("\n", end).encode(encoding))
    return path


@pytest.mark.parametrize("encoding", ENCODINGS.values(), ids=ENCODINGS)
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"], ids=["unix", "windows", "old mac"])
def test_every_encoding_is_read(tmp_path: Path, encoding: str, end: str) -> None:
    """Presets, and cuts as JSON and line by line."""
    preset = 'triangles = 40\nstyle = ["flat", "edges:width=1"]\n# Größe\n'
    assert read_preset(str(written(tmp_path / "a.toml", preset, encoding, end))) == {
        "triangles": 40,
        "styles": ["flat", "edges:width=1"],
    }
    for name, text in (("a.json", "[3,\n 40]\n"), ("a.txt", "3\n40\n")):
        assert read_cuts(written(tmp_path / name, text, encoding, end)) == {3, 40}


def test_mark_of_the_other_byte_order(tmp_path: Path) -> None:
    """Big-endian UTF-16 with its mark."""
    path = tmp_path / "a.txt"
    path.write_bytes(codecs.BOM_UTF16_BE + "3 40".encode("utf-16-be"))
    assert read_cuts(path) == {3, 40}


def test_what_is_no_text_is_one_line(tmp_path: Path) -> None:
    """Pictures, half a character, nothing at all."""
    for content in (b"\x89PNG\r\n\x1a\n\xff\xfe", b"\xff\xfea", b"caf\xe9 = 3"):
        path = tmp_path / "a"
        path.write_bytes(content)
        with pytest.raises(OptionError, match="not a TOML file"):
            read_preset(str(path))
        with pytest.raises(MediaError, match="cuts"):
            read_cuts(path)
    path.write_bytes(b"")
    assert read_cuts(path) == frozenset()


def test_a_file_that_never_ends_is_told() -> None:
    device = Path("/dev/zero")
    if not device.exists():
        pytest.skip("there is no such device")
    with pytest.raises(ValueError, match="larger than 1 MiB"):
        bounded_bytes(device, 1 << 20)
