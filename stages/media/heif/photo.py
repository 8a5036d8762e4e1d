"""Which coded pictures make the photo of a HEIF file, and how.

Source: ISO/IEC 23008-12 (HEIF), Sec. 6.5 and 6.6; ISO/IEC 14496-12, Sec. 8.11.
"""

import struct
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

from stages.media.heif.boxes import Box, Reader, top_boxes
from stages.media.orientation import Orientation
from warp_kernels.errors import OptionError

BRANDS = frozenset({"heic", "heix", "heim", "heis", "mif1", "mif2", "avif", "miaf", "1pic"})
"""Kinds of files that may hold a photo."""

_ALPHA = ("mpegB:cicp:systems:auxiliary:alpha", "hevc:2015:auxid:1")
_MOST_TILES = 65536
_AS_STORED = Orientation()


@dataclass(frozen=True)
class Photo:
    """The main picture of a file: coded pictures in rows, cropped, then turned."""

    tiles: tuple[int, ...]
    """Numbers of the coded pictures, row by row."""
    columns: int
    """Pictures in a row."""
    size: tuple[int, int]
    """Width and height of what the tiles show, without padding [px]."""
    crop: tuple[int, int, int, int] | None = None
    """Left, top, width and height of what is shown of that [px]; None for all."""
    orientation: Orientation = _AS_STORED
    """How it is shown."""
    profile: bytes | None = None
    """Its ICC profile."""
    mask: "Photo | None" = None
    """Its transparency: a photo whose brightness is the opacity."""
    others: int = 0
    """Other whole pictures in the file, which are not shown."""


@dataclass(frozen=True)
class _Items:
    """What a file's `meta` box says."""

    path: Path
    main: int
    kinds: Mapping[int, str]
    properties: Mapping[int, tuple[Box, ...]]
    parts: Mapping[int, tuple[int, ...]]
    """Which items an item is made from."""
    aids: Mapping[int, tuple[int, ...]]
    """Which items are auxiliary to an item."""
    hidden: frozenset[int]
    """Items that are shown only as a part or an aid."""
    places: Mapping[int, tuple[int, list[tuple[int, int]]]]
    """Where an item's data lie: the method, offsets and lengths."""
    data: bytes
    """Content of `idat`."""


def read_photo(path: Path, page: int | None = None) -> Photo | None:
    """The photo of a file, or None if the file is none that holds one.

    Args:
        path: The file.
        page: Which whole picture of several, from 1; None for the main one.

    Raises:
        OptionError: If there is no such picture.
        ValueError: If the file holds a photo that is damaged or made in a way that is not known.
        OSError: If it cannot be read.
    """
    boxes = top_boxes(path, frozenset({"ftyp", "meta"}))
    if "ftyp" not in boxes or "meta" not in boxes or "moov" in boxes:
        return None
    brands = boxes["ftyp"].content
    names = {brands[p : p + 4].decode("latin-1") for p in (0, *range(8, len(brands), 4))}
    if not names & BRANDS:
        return None
    try:
        items = _read_items(path, boxes["meta"])
        chosen = items.main if page is None else _whole_picture(items, page)
        photo = _photo_of(items, chosen)
        mask = _mask_of(items, chosen)
    except (struct.error, IndexError, KeyError, ZeroDivisionError) as error:
        raise ValueError(f"its boxes are damaged ({error})") from error
    return replace(photo, mask=mask, others=len(_whole_pictures(items)) - 1)


def _whole_pictures(items: _Items) -> list[int]:
    """Numbers of the pictures that are no part of another one, in order."""
    whole = {n for n, kind in items.kinds.items() if kind in _PICTURES and n not in items.hidden}
    return sorted(whole | {items.main})


def _whole_picture(items: _Items, page: int) -> int:
    whole = _whole_pictures(items)
    if page > len(whole):
        raise OptionError(f"--page {page}: {items.path} has {len(whole)}; give a smaller number")
    return whole[page - 1]


_PICTURES = frozenset({"hvc1", "hev1", "av01", "avc1", "vvc1", "jpeg", "grid", "iden", "iovl"})


def _photo_of(items: _Items, number: int) -> Photo:
    """What one item shows."""
    kind = items.kinds[number]
    if kind == "iden":
        (inner,) = items.parts[number]
        photo = _photo_of(items, inner)
        if photo.crop or photo.orientation != Orientation():
            raise ValueError("a photo derived from a turned one is not known")
    elif kind == "grid":
        photo = _grid_of(items, number)
    elif kind in _PICTURES and kind != "iovl":
        photo = Photo((number,), 1, _declared_size(items, number))
    else:
        raise ValueError(f"a photo of kind {kind!r} is not known")
    return _with_properties(photo, items.properties.get(number, ()))


def _grid_of(items: _Items, number: int) -> Photo:
    """A photo of several rows of tiles."""
    reader = Reader(_data_of(items, number))
    _, flags = reader.number(1), reader.number(1)
    rows, columns = reader.number(1) + 1, reader.number(1) + 1
    side = 4 if flags & 1 else 2
    size = reader.number(side), reader.number(side)
    tiles = items.parts.get(number, ())
    if len(tiles) != rows * columns or len(tiles) > _MOST_TILES or min(size) < 1:
        raise ValueError(f"{len(tiles)} tiles for {rows} rows of {columns}")
    return Photo(tiles, columns, size)


def _declared_size(items: _Items, number: int) -> tuple[int, int]:
    for box in items.properties.get(number, ()):
        if box.kind == "ispe":
            width, height = struct.unpack_from(">II", box.content, 4)
            return int(width), int(height)
    return 0, 0


def _with_properties(photo: Photo, properties: tuple[Box, ...]) -> Photo:
    """Crop and turn in the order in which the file lists it."""
    turn, mirrored = 0, False
    for box in properties:
        if box.kind == "clap":
            photo = replace(photo, crop=_crop_of(box.content, photo.size))
        elif box.kind == "irot":
            angle = (box.content[0] & 3) * 90
            turn = (turn + (-angle if mirrored else angle)) % 360
        elif box.kind == "imir":
            # 1 exchanges left and right, 0 top and bottom, which is the former and a half turn
            turn = (turn + (0 if box.content[0] & 1 else 180)) % 360
            mirrored = not mirrored
        elif box.kind == "colr" and box.content[:4] in (b"prof", b"rICC"):
            photo = replace(photo, profile=box.content[4:])
    return replace(photo, orientation=Orientation(turn, mirrored))


def _crop_of(content: bytes, size: tuple[int, int]) -> tuple[int, int, int, int]:
    """The clean aperture, whose place is stated from the middle of the picture."""
    values = struct.unpack_from(">IIIIiIiI", content)
    width, height, right, down = (Fraction(values[n], values[n + 1]) for n in (0, 2, 4, 6))
    left = Fraction(size[0] - 1, 2) + right - (width - 1) / 2
    top = Fraction(size[1] - 1, 2) + down - (height - 1) / 2
    first = max(0, round(left)), max(0, round(top))
    wide = min(round(width), size[0] - first[0])
    high = min(round(height), size[1] - first[1])
    if min(wide, high) < 1:
        raise ValueError("it is cropped to nothing")
    return (*first, wide, high)


def _mask_of(items: _Items, number: int) -> Photo | None:
    for aid in items.aids.get(number, ()):
        for box in items.properties.get(aid, ()):
            if box.kind == "auxC" and any(name.encode() in box.content for name in _ALPHA):
                return _photo_of(items, aid)
    return None


def _data_of(items: _Items, number: int) -> bytes:
    """The bytes of an item that is not a coded picture."""
    method, extents = items.places[number]
    if method == 1:
        return b"".join(items.data[begin : begin + length] for begin, length in extents)
    with items.path.open("rb") as file:
        parts = []
        for begin, length in extents:
            file.seek(begin)
            parts.append(file.read(min(length, 64)))
    return b"".join(parts)


def _read_items(path: Path, meta: Box) -> _Items:
    inside = {box.kind: box for box in meta.children(4)}
    main = Reader(inside["pitm"].content, 4).number(4 if inside["pitm"].version else 2)
    kinds = {}
    information = inside["iinf"]
    for box in information.children(8 if information.version else 6):
        reader = Reader(box.content, 4)
        number = reader.number(4 if box.version >= 3 else 2)
        reader.number(2)
        kinds[number] = reader.raw(4).decode("latin-1") if box.version >= 2 else ""
    parts, aids = _references(inside.get("iref"))
    owned = {tile for group in parts.values() for tile in group}
    owned |= {aid for group in aids.values() for aid in group}
    idat = inside.get("idat")
    return _Items(
        path,
        main,
        kinds,
        _properties(inside["iprp"]),
        parts,
        aids,
        frozenset(owned),
        _places(inside["iloc"]),
        idat.content if idat else b"",
    )


def _references(
    box: Box | None,
) -> tuple[dict[int, tuple[int, ...]], dict[int, tuple[int, ...]]]:
    """Which items are parts of an item, and which are auxiliary to it."""
    parts: dict[int, tuple[int, ...]] = {}
    aids: dict[int, tuple[int, ...]] = {}
    for reference in box.children(4) if box else ():
        side = 4 if box and box.version else 2
        reader = Reader(reference.content)
        origin = reader.number(side)
        targets = tuple(reader.number(side) for _ in range(reader.number(2)))
        if reference.kind == "dimg":
            parts[origin] = targets
        elif reference.kind in ("auxl", "thmb"):
            for target in targets:
                aids[target] = (*aids.get(target, ()), origin)
    return parts, aids


def _properties(iprp: Box) -> dict[int, tuple[Box, ...]]:
    """Properties of every item, in the order of their association."""
    shared = iprp.child("ipco")
    every = list(shared.children()) if shared else []
    found: dict[int, tuple[Box, ...]] = {}
    for box in iprp.children():
        if box.kind != "ipma":
            continue
        reader = Reader(box.content, 4)
        for _ in range(reader.number(4)):
            number = reader.number(4 if box.version else 2)
            wide = 2 if box.flags & 1 else 1
            mask = 0x7FFF if box.flags & 1 else 0x7F
            places = [reader.number(wide) & mask for _ in range(reader.number(1))]
            chosen = tuple(every[place - 1] for place in places if place)
            found[number] = (*found.get(number, ()), *chosen)
    return found


def _places(iloc: Box) -> dict[int, tuple[int, list[tuple[int, int]]]]:
    """Where the items' data lie."""
    reader, version = Reader(iloc.content, 4), iloc.version
    sizes = reader.number(2)
    offset, length, base, index = (sizes >> shift & 15 for shift in (12, 8, 4, 0))
    found = {}
    for _ in range(reader.number(4 if version == 2 else 2)):
        number = reader.number(4 if version == 2 else 2)
        method = reader.number(2) & 15 if version else 0
        reader.number(2)
        start = reader.number(base)
        extents = []
        for _ in range(reader.number(2)):
            reader.number(index if version else 0)
            begin = start + reader.number(offset)
            extents.append((begin, reader.number(length)))
        found[number] = (method, extents)
    return found
