"""Arrays that come from elsewhere, as frames."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from stages.frame import Frame
from stages.media import MediaInfo
from warp_kernels.errors import OptionError
from warp_kernels.limits import MAX_SIDE

RATE = Fraction(1, 25)
"""Arrays have no time; a frame must have one, and nothing depends on it."""


def frame_of(pixels: Any, index: int) -> Frame:
    """A frame with pixels of its own: the caller may go on with the array.

    Args:
        pixels: Code values, [H, W, 3] uint8 in RGB, or [H, W] uint8 in grey; anything that NumPy
            makes such an array of.
        index: Number of the frame.

    Raises:
        OptionError: If it is another array.
    """
    try:
        array = np.asarray(pixels)
    except ValueError as error:  # rows of different lengths
        raise OptionError(
            f"pixels: NumPy makes no array of them ({error}); give [H, W, 3] or [H, W] uint8"
        ) from error
    _check_kind(array)
    if array.ndim == 2:
        array = np.repeat(array[..., None], 3, axis=2)
    own = np.array(array, order="C")
    own.flags.writeable = False
    return Frame(index, index, RATE, own)


def info_of(size: tuple[int, int], kind: str, path: Path = Path()) -> MediaInfo:
    """What is known about a source that is no file.

    Args:
        size: Width and height of its pictures [px].
        kind: `image` for one picture, `video` for frames that follow each other.
        path: A name for it.
    """
    width, height = size
    return MediaInfo(
        path=path,
        kind=kind,
        container="",
        codec="",
        pixel_format="rgb24",
        width=width,
        height=height,
        coded_width=width,
        coded_height=height,
        rotation=0,
        sample_aspect=Fraction(1),
        time_base=RATE,
        average_rate=1 / RATE,
        frame_count=None,
        start_time=Fraction(0),
        duration=None,
        color_matrix="rgb",
        color_range="full",
        hdr=None,
        audio_codec=None,
        audio_channels=None,
        audio_rate=None,
    )


def weights_of(weights: Any, size: tuple[int, int]) -> np.ndarray:
    """Weights of the pixels of a picture, [H, W] uint8; none is without.

    Args:
        weights: White (255) where errors count most, [H, W] uint8.
        size: Width and height of the picture [px].

    Raises:
        OptionError: If it is another array, or black all over.
    """
    array = np.asarray(weights)
    width, height = size
    if array.shape != (height, width) or array.dtype != np.uint8:
        raise OptionError(
            f"weights: an array of {_described(array)}; give one of {height}x{width} uint8 for "
            f"this picture, or the name of a file"
        )
    if not array.any():
        raise OptionError("weights: black all over; make white (255) what counts most")
    return np.maximum(array, 1)


def _check_kind(array: np.ndarray) -> None:
    """Refuse what is no picture, and say how to make one of it."""
    remedy = ""
    if array.ndim not in (2, 3) or (array.ndim == 3 and array.shape[2] != 3):
        remedy = "give [H, W, 3] for RGB or [H, W] for grey"
        if array.ndim == 3 and array.shape[2] == 4:
            remedy = "leave its alpha out: pixels[..., :3]"
        if array.ndim == 3 and array.shape[2] == 1:
            remedy = "give it as grey: pixels[..., 0]"
    elif array.dtype != np.uint8:
        remedy = "give code values from 0 to 255 as uint8"
        if array.dtype.kind == "f":
            remedy += ", of 0 to 1: (255 * pixels).round().astype('uint8')"
    elif not 1 <= min(array.shape[:2]) <= max(array.shape[:2]) <= MAX_SIDE:
        remedy = f"sides must lie between 1 and {MAX_SIDE} pixels"
    if remedy:
        raise OptionError(f"pixels: an array of {_described(array)}; {remedy}")


def _described(array: np.ndarray) -> str:
    """Shape and type of an array, for messages."""
    return f"{'x'.join(map(str, array.shape)) or 'no dimension'} {array.dtype}"
