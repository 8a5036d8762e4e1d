"""Turning stored pictures upright, and mirrored ones as a player shows them."""

import struct
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from av.video.frame import VideoFrame

from stages.media.reading.side_data import side_data

MAX_SAMPLE_ASPECT = Fraction(8)
"""Pixels stretched by more than this are taken for a mistake in the file."""


@dataclass(frozen=True)
class Orientation:
    """How a stored picture is to be shown: one of eight ways."""

    rotation: int = 0
    """Counter-clockwise turn [degrees: 0, 90, 180, 270]."""
    mirrored: bool = False
    """Whether left and right are exchanged after that."""

    @property
    def is_sideways(self) -> bool:
        """Whether width and height are exchanged."""
        return self.rotation in (90, 270)


def orientation_of(frame: VideoFrame) -> Orientation:
    """How a frame is to be shown; FFmpeg gives EXIF orientations as a matrix, too.

    Args:
        frame: A decoded frame.
    """
    matrix = side_data(frame, "DISPLAYMATRIX")
    if matrix is None or len(matrix) < 36:
        return Orientation()
    a, b, _, c, d, *_ = struct.unpack("=9i", matrix[:36])
    return orientation_from(a, b, c, d)


def orientation_from(a: float, b: float, c: float, d: float) -> Orientation:
    """The nearest of the eight ways to a matrix.

    A stored point (x, y) is shown at (a x + c y, b x + d y); x points right, y down.

    Args:
        a: See above.
        b: See above.
        c: See above.
        d: See above.
    """
    mirrored = a * d - b * c < 0
    if mirrored:  # undo it, so that a turn is left
        a, c = -a, -c
    if abs(a + d) >= abs(b - c):
        return Orientation(180 if a + d < 0 else 0, mirrored)
    return Orientation(90 if c > b else 270, mirrored)


def upright(pixels: np.ndarray, orientation: Orientation) -> np.ndarray:
    """Turn a picture.

    Args:
        pixels: Stored picture, [H, W, C].
        orientation: How it is to be shown.

    Returns:
        The picture as it is shown, C-contiguous; the argument itself when nothing is to be done.
    """
    if orientation.rotation:
        pixels = np.rot90(pixels, k=orientation.rotation // 90)
    if orientation.mirrored:
        pixels = pixels[:, ::-1]
    return np.ascontiguousarray(pixels)


def sane_aspect(stored: Fraction | None, orientation: Orientation) -> Fraction | None:
    """Sample aspect of the upright picture.

    Args:
        stored: Pixel width over height as stored; None or 0 if unknown.
        orientation: How the picture is to be shown.

    Returns:
        The aspect, 1 if unknown; None if the stored one is beyond belief.
    """
    if not stored or stored < 0:
        return Fraction(1)
    if not 1 / MAX_SAMPLE_ASPECT <= stored <= MAX_SAMPLE_ASPECT:
        return None
    return Fraction(1 / stored if orientation.is_sideways else stored)
