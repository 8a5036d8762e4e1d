"""The coded pictures of a photo, put together to one."""

import re
from collections.abc import Mapping

import numpy as np
from av.video.frame import VideoFrame
from av.video.plane import VideoPlane
from av.video.reformatter import ColorRange, VideoReformatter

from stages.media.heif.photo import Photo


def compose(photo: Photo, pictures: Mapping[int, VideoFrame]) -> VideoFrame:
    """Put a photo together; nothing is converted, so no seam shows.

    Args:
        photo: How it is made.
        pictures: The decoded pictures by their numbers.

    Returns:
        The photo, cropped but not turned.

    Raises:
        ValueError: If a picture is missing or of another size or format.
    """
    whole = _joined(photo, pictures)
    if photo.mask is not None:
        whole = _with_mask(whole, _joined(photo.mask, pictures))
    return whole if photo.crop is None else _cropped(whole, photo.crop)


def _joined(photo: Photo, pictures: Mapping[int, VideoFrame]) -> VideoFrame:
    """The tiles side by side, without their padding."""
    missing = [number for number, tile in enumerate(photo.tiles) if tile not in pictures]
    if missing:
        raise ValueError(f"part {missing[0] + 1} of {len(photo.tiles)} cannot be decoded")
    tiles = [pictures[tile] for tile in photo.tiles]
    first = tiles[0]
    if any((t.width, t.height, t.format.name) != _shape(first) for t in tiles):
        raise ValueError("its parts are of several kinds")
    width, height = (
        min(declared or side, side) if len(tiles) == 1 else declared
        for declared, side in zip(photo.size, (first.width, first.height), strict=True)
    )
    rows = len(tiles) // photo.columns
    if width > first.width * photo.columns or height > first.height * rows:
        raise ValueError(f"its parts do not fill {width}x{height}")
    if len(tiles) == 1 and (width, height) == (first.width, first.height):
        return first
    whole = _empty(width, height, first.format.name, first)
    for number, tile in enumerate(tiles):
        row, column = divmod(number, photo.columns)
        _paste(tile, whole, column * first.width, row * first.height)
    return whole


def _shape(frame: VideoFrame) -> tuple[int, int, str]:
    return frame.width, frame.height, frame.format.name


def _with_mask(picture: VideoFrame, mask: VideoFrame) -> VideoFrame:
    """A picture whose opacity is the brightness of another one."""
    depth = "" if picture.format.components[0].bits == 8 else "16le"
    opacity = VideoReformatter().reformat(
        mask,
        width=picture.width,
        height=picture.height,
        format=f"gray{depth}",
        dst_color_range=ColorRange.JPEG,
    )
    made = VideoReformatter().reformat(picture, format=f"yuva444p{depth}")
    _understand_like(made, picture)
    rows, given = _rows(made.planes[3]), _rows(opacity.planes[0])
    across = min(rows.shape[1], given.shape[1])
    rows[:, :across] = given[:, :across]
    return made


def _cropped(frame: VideoFrame, crop: tuple[int, int, int, int]) -> VideoFrame:
    left, top, width, height = crop
    if left % 2 or top % 2:  # between two chroma samples
        name = re.sub("4[12][01]p", "444p", frame.format.name)
        whole = VideoReformatter().reformat(frame, format=name)
        _understand_like(whole, frame)
        frame = whole
    part = _empty(width, height, frame.format.name, frame)
    _paste(frame, part, -left, -top)
    return part


def _empty(width: int, height: int, name: str, like: VideoFrame) -> VideoFrame:
    """A frame whose colours are understood like those of another one."""
    frame = VideoFrame(width, height, name)
    _understand_like(frame, like)
    return frame


def _understand_like(frame: VideoFrame, like: VideoFrame) -> None:
    """Tag a frame as another one is tagged."""
    frame.colorspace, frame.color_range = like.colorspace, like.color_range
    frame.color_primaries, frame.color_trc = like.color_primaries, like.color_trc
    frame.pts, frame.time_base = 0, like.time_base


def _paste(source: VideoFrame, target: VideoFrame, left: int, top: int) -> None:
    """Copy what of one frame lies inside another; a negative place cuts its beginning off."""
    for plane, (given, taken) in enumerate(zip(source.planes, target.planes, strict=True)):
        component = next(c for c in source.format.components if c.plane == plane)
        wide = 2 if component.bits > 8 else 1
        across = max(1, round(source.width / given.width))
        down = max(1, round(source.height / given.height))
        x, y = left // across, top // down
        rows = _rows(given)[max(0, -y) :, max(0, -x) * wide : given.width * wide]
        inside = _rows(taken)[:, : taken.width * wide]
        inside = inside[max(0, y) :, max(0, x) * wide :]
        high, long = min(len(rows), len(inside)), min(rows.shape[1], inside.shape[1])
        inside[:high, :long] = rows[:high, :long]


def _rows(plane: VideoPlane) -> np.ndarray:
    """Bytes of a plane, [its height, its line with padding]; writing changes the plane."""
    return np.frombuffer(memoryview(plane), np.uint8).reshape(-1, abs(plane.line_size))[
        : plane.height
    ]
