"""Palettes in files: colours line by line, GIMP, Adobe swatches, JSON."""

import json
import re
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from stages.media.text_file import bounded_bytes, text_of
from stages.toning.palette import MOST_COLORS, Color
from warp_kernels.errors import MediaError, OptionError
from warp_kernels.styles.color import parse_color

ENDINGS = frozenset({".txt", ".hex", ".csv", ".json", ".gpl", ".ase", ".aco"})
"""Endings of palettes; every other file is a picture."""
UNORDERED = frozenset({".gpl", ".ase", ".aco"})
"""Those of drawers of colours, whose order says nothing of their brightness."""
MOST_BYTES = 2**22
"""No palette is larger."""
FORM = "write #rgb, #rrggbb or a name a line, or give a .gpl, .ase, .aco, .json or a picture"
"""The remedy for a file that is none."""


def read_swatches(path: Path) -> tuple[Color, ...]:
    """Read the colours of a file by its ending.

    Args:
        path: A file whose ending is one of `ENDINGS`.

    Returns:
        Its colours in order, each as often as it is there, at most `MOST_COLORS`.

    Raises:
        MediaError: If it cannot be read, or holds no palette.
    """
    try:
        content = bounded_bytes(path, MOST_BYTES)
        found = tuple(_READERS.get(path.suffix.lower(), _lines)(content))
    except OSError as error:
        raise MediaError(path, f"cannot be read ({str(error.strerror).lower()})", FORM) from error
    except (ValueError, OptionError, struct.error, RecursionError) as error:
        cut = isinstance(error, struct.error) or not str(error).strip()
        reason = "it ends too early" if cut else " ".join(str(error).split())
        raise MediaError(path, f"is no palette ({reason[:120]})", FORM) from error
    if not 2 <= len(found) <= MOST_COLORS:
        count = "no colour" if not found else f"{len(found)} colours"
        raise MediaError(path, f"holds {count}, and a palette has 2 to {MOST_COLORS}", FORM)
    return found


def _lines(content: bytes) -> Iterator[Color]:
    """One colour a line, or three numbers; what follows # without being a colour is a comment."""
    for number, line in enumerate(text_of(content).split("\n"), start=1):
        text = line.strip().strip(",;\"'")
        if not text or text.startswith(("//", ";", "# ", "##")) or text == "#":
            continue
        try:
            yield _color_of(text)
        except OptionError as error:
            raise OptionError(f"line {number}: {error}") from error


def _color_of(text: str) -> Color:
    """A colour of one line."""
    match = re.fullmatch(r"(\d{1,3})[\s,;]+(\d{1,3})[\s,;]+(\d{1,3})", text)
    if match is None:
        return parse_color(text)
    return _bounded(*(float(part) for part in match.groups()))


def _bounded(red: float, green: float, blue: float) -> Color:
    if not all(0.0 <= value <= 255.0 for value in (red, green, blue)):
        raise OptionError(f"{red:g} {green:g} {blue:g}: numbers must lie between 0 and 255")
    return red, green, blue


def _gimp(content: bytes) -> Iterator[Color]:
    """A palette of GIMP, Inkscape or Krita: a header, then red, green, blue and a name a line.

    Source: https://developer.gimp.org/core/standards/gpl/
    """
    lines = text_of(content).split("\n")
    if lines[0].strip() != "GIMP Palette":
        raise ValueError(f"its first line is {lines[0][:20]!r}, not GIMP Palette")
    for number, line in enumerate(lines[1:], start=2):
        text = line.strip()
        if not text or text.startswith("#") or re.match(r"(Name|Columns|Channels):", text):
            continue
        match = re.match(r"(\d+)\s+(\d+)\s+(\d+)(\s|$)", text)
        if match is None:
            raise ValueError(f"line {number}: {text[:30]!r} is no RED GREEN BLUE NAME")
        yield _bounded(*(float(match[k]) for k in (1, 2, 3)))


def _json(content: bytes) -> Iterator[Color]:
    """A list of texts or of three numbers, alone or as `colors` or `palette` of an object."""
    held = json.loads(text_of(content))
    if isinstance(held, dict):
        named = [held[key] for key in ("colors", "colours", "palette", "swatches") if key in held]
        if not named:
            raise ValueError('it has no "colors"')
        held = named[0]
    if not isinstance(held, list):
        raise ValueError("it is no list of colours")
    for number, entry in enumerate(held, start=1):
        yield _json_color(entry, number)


def _json_color(entry: Any, number: int) -> Color:
    """An entry of a list: a text, three numbers, or an object that has one of them."""
    if isinstance(entry, dict):
        entry = next((entry[key] for key in ("color", "hex", "rgb", "value") if key in entry), None)
    if isinstance(entry, str):
        return parse_color(entry)
    if isinstance(entry, list) and len(entry) in (3, 4) and all(map(_is_number, entry)):
        return _bounded(*(float(value) for value in entry[:3]))
    raise ValueError(f"colour {number} is neither a text such as #fa0 nor three numbers to 255")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _exchange(content: bytes) -> Iterator[Color]:
    """Adobe Swatch Exchange: blocks, of which those of the kind 1 are colours, big endian."""
    magic, _, _, count = struct.unpack_from(">4sHHI", content)
    if magic != b"ASEF":
        raise ValueError("it does not begin with ASEF")
    place = 12
    for _ in range(count):
        kind, length = struct.unpack_from(">HI", content, place)
        body = content[place + 6 : place + 6 + length]
        place += 6 + length
        if kind != 1:
            continue
        (letters,) = struct.unpack_from(">H", body)
        at = 2 + 2 * letters
        model = body[at : at + 4].decode("ascii", "replace").strip()
        yield _exchanged(model, body[at + 4 :])


def _exchanged(model: str, numbers: bytes) -> Color:
    """A colour of an exchange file."""
    if model == "RGB":
        return _bounded(*(255.0 * v for v in struct.unpack_from(">3f", numbers)))
    if model.lower() == "gray":
        (grey,) = struct.unpack_from(">f", numbers)
        return _bounded(255.0 * grey, 255.0 * grey, 255.0 * grey)
    if model == "CMYK":
        c, m, y, k = struct.unpack_from(">4f", numbers)
        return _bounded(*(255.0 * (1.0 - ink) * (1.0 - k) for ink in (c, m, y)))
    raise ValueError(f"its colours are {model}; save them as RGB")


def _photoshop(content: bytes) -> Iterator[Color]:
    """Colours of Photoshop, version 1, with which every file begins; 16 bits a number."""
    version, count = struct.unpack_from(">HH", content)
    if version not in (1, 2):
        raise ValueError(f"version {version} of .aco is not known")
    place = 4
    for _ in range(count):
        space, *numbers = struct.unpack_from(">H4H", content, place)
        place += 10
        if version == 2:
            (letters,) = struct.unpack_from(">I", content, place)
            place += 4 + 2 * letters
        if space == 0:
            yield _bounded(*(value / 257.0 for value in numbers[:3]))
        elif space == 8:
            yield _bounded(*[255.0 * numbers[0] / 10000.0] * 3)
        elif space == 2:
            ink = [value / 65535.0 for value in numbers]  # 0 is all of it
            yield _bounded(*(255.0 * part * ink[3] for part in ink[:3]))
        else:
            raise ValueError(f"its colours are of the space {space}; save them as RGB")


_READERS: dict[str, Callable[[bytes], Iterator[Color]]] = {
    ".gpl": _gimp,
    ".json": _json,
    ".ase": _exchange,
    ".aco": _photoshop,
}
"""What reads a file of an ending; all others are read line by line."""
