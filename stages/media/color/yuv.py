"""Stored pixels to RGB and back, with the matrix and the range always stated.

Left to itself swscale takes BT.601 for untagged video and rounds with a bias; see FLAGS.
"""

from dataclasses import dataclass, replace
from functools import lru_cache

import av
import cv2
import numpy as np
from av.video.frame import VideoFrame
from av.video.reformatter import ColorRange, Colorspace, Interpolation, VideoReformatter

from stages.media.color.icc_profile import ColorTransform, transform_of, transform_of_primaries

FLAGS = int(Interpolation.BICUBIC | Interpolation.ACCURATE_RND | Interpolation.FULL_CHR_H_INT)
"""The default flags bias colours by about one code value; these do not."""

WHITE = 255
"""Code value of white paper."""
PLANES = "gbrp"
"""FFmpeg's format of a plane each for green, blue and red."""

_BT709 = 1
_FULL, _LIMITED = int(ColorRange.JPEG), int(ColorRange.MPEG)
_MATRICES = {
    1: ("bt709", Colorspace.ITU709),
    4: ("fcc", Colorspace.FCC),
    5: ("bt601", Colorspace.ITU601),
    6: ("bt601", Colorspace.ITU601),
    7: ("smpte240m", Colorspace.SMPTE240M),
    9: ("bt2020", Colorspace.BT2020),
    10: ("bt2020", Colorspace.BT2020),
}
_UNTAGGED = (0, 2, 3)
_TRANSFERS = {16: "pq", 18: "hlg"}


@dataclass(frozen=True)
class ColorReading:
    """How the stored pixels of a source are understood."""

    matrix: str
    """Name of the matrix, `rgb` if the pixels are stored as RGB."""
    colorspace: int
    """The same as swscale's number."""
    full_range: bool
    """Whether 0..255 are used rather than 16..235."""
    hdr: str | None
    """`pq`, `hlg` or None."""
    notes: tuple[str, ...]
    """What had to be guessed, one sentence each."""
    transform: ColorTransform | None = None
    """From the colours of its profile or primaries to those of sRGB; None where they are these."""


def read_color(frame: VideoFrame, profile: bytes | None = None) -> ColorReading:
    """Decide how a frame's pixels are to be understood.

    Args:
        frame: A decoded frame.
        profile: Its ICC profile, or None.
    """
    color = _read_matrix(frame)
    if color.hdr is not None:
        return color  # tone mapping ends in sRGB's colours already
    transform, told = _read_profile(frame.format.name, frame.color_primaries, profile)
    return replace(color, transform=transform, notes=(*color.notes, *told))


@lru_cache(maxsize=4)
def _read_profile(
    format_name: str, primaries: int, profile: bytes | None
) -> tuple[ColorTransform | None, tuple[str, ...]]:
    """How colours get to sRGB, and what is to be told of it."""
    if profile is None:
        transform = transform_of_primaries(primaries)
    else:
        try:
            transform = transform_of(profile, gray=format_name.startswith(("gray", "ya", "mono")))
        except ValueError as error:
            return None, (f"colour profile left out, colours are taken as sRGB: {error}",)
        if transform.is_srgb:
            return None, ()
    if transform is None:
        return None, ()
    return transform, (f"colours converted from {transform.name} to sRGB",)


def _read_matrix(frame: VideoFrame) -> ColorReading:
    """How a frame's pixels become RGB.

    Untagged video is BT.709 when it is at least 1280 wide or more than 576 high, else BT.601,
    as most players do.
    """
    if frame.format.is_rgb or "pal8" in frame.format.name:
        return ColorReading("rgb", Colorspace.ITU709, True, _TRANSFERS.get(frame.color_trc), ())
    notes: list[str] = []
    large = frame.width >= 1280 or frame.height > 576
    matrix, colorspace = _MATRICES[1 if large else 6]
    gray = frame.format.name.startswith(("gray", "ya", "mono"))
    if frame.colorspace in _MATRICES:
        matrix, colorspace = _MATRICES[frame.colorspace]
    elif frame.colorspace not in _UNTAGGED:
        notes.append(f"colour matrix {frame.colorspace} is not known: taken as {matrix}")
    elif not gray and _is_doubtful(frame.width, frame.height):
        notes.append(
            f"untagged colour of {frame.width}x{frame.height}, which players take differently: "
            f"taken as {matrix}"
        )
    full = frame.color_range == _FULL or frame.format.name.startswith("yuvj")
    if gray and frame.color_range != _LIMITED:
        full = True
    hdr = _TRANSFERS.get(frame.color_trc)
    return ColorReading(matrix, int(colorspace), full, hdr, tuple(notes))


def _is_doubtful(width: int, height: int) -> bool:
    """Whether players disagree about untagged video of this size [px].

    They call a picture large by its width, or by its height from one of two bounds on. Where all
    agree there is no choice to be told of.
    """
    return len({width >= 1280, height > 576, height >= 720}) > 1


class RgbReader:
    """Converts decoded frames to RGB; keeps its converter between frames."""

    def __init__(self, paper: int = WHITE) -> None:
        """Prepare for a source.

        Args:
            paper: Grey that shows through transparent pixels [code value].
        """
        self.saw_transparency = False
        """Whether a frame had transparent pixels, through which the paper shows."""
        self._paper = paper
        self._reformatter = VideoReformatter()

    def read8(self, frame: VideoFrame, color: ColorReading, size: tuple[int, int]) -> np.ndarray:
        """Convert to 8 bits.

        Args:
            frame: A decoded frame.
            color: How to understand it.
            size: Width and height of the result [px]; a frame of another size is scaled.

        Returns:
            Code values, [H, W, 3] uint8.
        """
        if has_alpha(frame):
            rgba = self._convert(frame, color, "rgba", size)
            if color.transform is not None:
                rgba[..., :3] = color.transform.apply(rgba[..., :3])
            return self._over_paper(rgba)
        if frame.format.is_rgb:
            pixels = self._convert(frame, color, "rgb24", size)
        else:
            pixels = cv2.merge(_planes(self._reformatted(frame, color, PLANES, size)))
        if not color.full_range and frame.format.name.startswith(("gray", "ya")):
            pixels = _EXPAND_GRAY[pixels]
        return pixels if color.transform is None else color.transform.apply(pixels)

    def read16(self, frame: VideoFrame, color: ColorReading, size: tuple[int, int]) -> np.ndarray:
        """Convert to 16 bits, for tone mapping.

        Args:
            frame: A decoded frame.
            color: How to understand it.
            size: Width and height of the result [px]; a frame of another size is scaled.

        Returns:
            Code values, [H, W, 3] uint16.
        """
        return self._convert(frame, color, "rgb48le", size)

    def _convert(
        self, frame: VideoFrame, color: ColorReading, layout: str, size: tuple[int, int]
    ) -> np.ndarray:
        return np.ascontiguousarray(self._reformatted(frame, color, layout, size).to_ndarray())

    def _reformatted(
        self, frame: VideoFrame, color: ColorReading, layout: str, size: tuple[int, int]
    ) -> VideoFrame:
        return self._reformatter.reformat(
            frame,
            width=size[0],
            height=size[1],
            format=layout,
            src_colorspace=color.colorspace,
            src_color_range=_FULL if color.full_range else _LIMITED,
            dst_color_range=_FULL,
            interpolation=FLAGS,
        )

    def _over_paper(self, rgba: np.ndarray) -> np.ndarray:
        alpha = rgba[..., 3]
        if alpha.min() == 255:
            return np.ascontiguousarray(rgba[..., :3])
        self.saw_transparency = True
        return over_paper(rgba, self._paper)


def _planes(frame: VideoFrame) -> list[np.ndarray]:
    """Red, green and blue of a frame of planes, as they lie in its memory; each [H, W] uint8.

    swscale works out planes with the processor's wide registers, and pixels of three bytes one by
    one; the code values are the same, in half of the time.
    """
    green, blue, red = (
        np.frombuffer(memoryview(plane), np.uint8).reshape(frame.height, plane.line_size)[
            :, : frame.width
        ]
        for plane in frame.planes
    )
    return [red, green, blue]


class YuvWriter:
    """Converts RGB pictures to frames for an encoder, tagged with what they are.

    RGB formats stay RGB; JPEG's are full-range BT.601; all others are limited-range BT.709.
    """

    def __init__(self, pixel_format: str) -> None:
        """Prepare for an encoder.

        Args:
            pixel_format: FFmpeg's name of the format that the encoder takes.
        """
        self.pixel_format = pixel_format
        self._reformatter = VideoReformatter()
        self._source: VideoFrame | None = None
        self._rgb = av.VideoFormat(pixel_format, 16, 16).is_rgb or pixel_format == "pal8"
        self._jpeg = pixel_format.startswith("yuvj")
        has_room = any(c.is_alpha for c in av.VideoFormat(pixel_format, 16, 16).components)
        self.drops_alpha = not has_room
        """Whether the format has no place for transparency."""

    def write(self, pixels: np.ndarray) -> VideoFrame:
        """Convert a picture.

        Args:
            pixels: Code values, [H, W, 3] or [H, W, 4] uint8.
        """
        layout = "rgba" if pixels.shape[2] == 4 else "rgb24"
        if layout == "rgb24" and not self._rgb:
            source = self._in_planes(pixels)
        else:
            source = VideoFrame.from_ndarray(np.ascontiguousarray(pixels), format=layout)
        if self.pixel_format == layout:
            return source
        frame = self._reformatter.reformat(
            source,
            format=self.pixel_format,
            dst_colorspace=None if self._rgb else self._matrix,
            src_color_range=_FULL,
            dst_color_range=_FULL if self._rgb or self._jpeg else _LIMITED,
            interpolation=FLAGS,
        )
        if not self._rgb and not self._jpeg:
            tag_bt709(frame)
        return frame

    def _in_planes(self, pixels: np.ndarray) -> VideoFrame:
        """A picture as a frame of planes; the next one takes its memory."""
        height, width = pixels.shape[:2]
        if self._source is None or (self._source.width, self._source.height) != (width, height):
            self._source = VideoFrame(width, height, PLANES)
        cv2.split(pixels, _planes(self._source))
        return self._source

    @property
    def _matrix(self) -> int:
        return int(Colorspace.ITU601 if self._jpeg else Colorspace.ITU709)


def tag_bt709(target: "VideoFrame | av.VideoCodecContext") -> None:
    """Write the four tags of limited-range BT.709.

    Args:
        target: A frame or an encoder that is not open yet.
    """
    target.colorspace = _BT709
    target.color_range = _LIMITED
    target.color_primaries = _BT709
    target.color_trc = _BT709


def over_paper(rgba: np.ndarray, paper: int = WHITE) -> np.ndarray:
    """Lay a picture over paper.

    Args:
        rgba: Code values with straight alpha, [H, W, 4] uint8.
        paper: Grey of the paper [code value].

    Returns:
        Code values, [H, W, 3] uint8.
    """
    alpha = rgba[..., 3:].astype(np.uint32)
    mixed = rgba[..., :3] * alpha + paper * (255 - alpha)
    return ((mixed + 127) // 255).astype(np.uint8)


def has_alpha(frame: VideoFrame) -> bool:
    """Whether a frame's format can hold transparency.

    Args:
        frame: A decoded frame.
    """
    return "pal8" in frame.format.name or any(c.is_alpha for c in frame.format.components)


_EXPAND_GRAY = np.clip(np.rint((np.arange(256) - 16.0) * 255 / 219), 0, 255).astype(np.uint8)
