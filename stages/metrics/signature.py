"""A small description of a picture by which shots are told apart."""

from dataclasses import dataclass

import cv2
import numpy as np

from stages.flows.view import View

BLOCKS = (9, 16)
"""Rows and columns of a signature's colours."""
PIXELS_PER_BLOCK = 8
"""Samples across and down that stand for a block: a coarse grid is enough for its mean."""
LONG_SIDE = 96
"""Longer side of a signature's thumbnail [px]."""
PATCH = 16
"""Side of the patches of a thumbnail that are looked for in another one [px]."""
REACH = 24
"""How far they are looked for [px]: a quarter of the picture's longer side."""
FLAT = 3.0
"""Patches whose standard deviation is less show noise, and nothing by it [code values]."""


@dataclass(frozen=True, eq=False, slots=True)
class Signature:
    """What a decision about a cut needs to know of a picture."""

    colors: np.ndarray
    """Mean colours of a coarse grid of blocks [code values], [9, 16, 3] float32."""
    thumbnail: np.ndarray
    """The picture, small, [h, w, 3] uint8; no side is shorter than a patch."""


def signature(view: View) -> Signature:
    """Describe a picture.

    Args:
        view: The picture.
    """
    return Signature(_colors(view.pixels), _thumbnail(view.coarse))


def change(a: Signature, b: Signature) -> float:
    """Mean absolute difference of two signatures' colours [code values]."""
    return float(np.abs(a.colors - b.colors).mean())


def likeness(a: Signature, b: Signature) -> float:
    """How much of two pictures shows the same things, wherever and however bright they are.

    Patches of either are looked for in the other. Even in a picture of something else they find
    something similar: 0.5 to 0.65 is usual then, and over 0.85 between frames of one shot.

    Returns:
        Mean correlation of the patches with what is most like them, by their contrast; the lower
        one of both ways. Pictures that show nothing are alike, 1, if their colours are.
    """
    found = _found(a.thumbnail, b.thumbnail), _found(b.thumbnail, a.thumbnail)
    known = [value for value in found if value is not None]
    return min(known, default=float(change(a, b) < FLAT))


def _colors(pixels: np.ndarray) -> np.ndarray:
    rows, columns = BLOCKS
    y = _centres(pixels.shape[0], rows * PIXELS_PER_BLOCK)
    x = _centres(pixels.shape[1], columns * PIXELS_PER_BLOCK)
    samples = pixels[np.ix_(y, x)].astype(np.float32)
    return samples.reshape(rows, PIXELS_PER_BLOCK, columns, PIXELS_PER_BLOCK, 3).mean(axis=(1, 3))


def _thumbnail(pixels: np.ndarray) -> np.ndarray:
    height, width = pixels.shape[:2]
    scale = LONG_SIDE / max(height, width)
    size = max(PATCH, round(width * scale)), max(PATCH, round(height * scale))
    return cv2.resize(pixels, size, interpolation=cv2.INTER_AREA)


def _found(picture: np.ndarray, other: np.ndarray) -> float | None:
    """How well the patches of a thumbnail are found in another one; None if it shows nothing."""
    around = np.pad(other, [(REACH, REACH), (REACH, REACH), (0, 0)], mode="edge")
    height, width = picture.shape[:2]
    total = weights = 0.0
    for y in range(0, height - PATCH + 1, PATCH):
        for x in range(0, width - PATCH + 1, PATCH):
            patch = picture[y : y + PATCH, x : x + PATCH]
            contrast = float(patch.std(axis=(0, 1)).max())
            if contrast >= FLAT:
                place = around[y : y + PATCH + 2 * REACH, x : x + PATCH + 2 * REACH]
                total += contrast * _best_match(patch, place)
                weights += contrast
    return total / weights if weights else None


def _best_match(patch: np.ndarray, place: np.ndarray) -> float:
    """Highest correlation of a patch with what lies around its place; 0 if there is none."""
    found = cv2.matchTemplate(place, patch, cv2.TM_CCOEFF_NORMED)
    # Where there is no contrast OpenCV divides by zero, more or less.
    known = found[np.isfinite(found) & (np.abs(found) <= 1.001)]
    return max(0.0, float(known.max(initial=0.0)))


def _centres(length: int, count: int) -> np.ndarray:
    """Pixel numbers at the centres of `count` equal parts of `length` pixels."""
    return ((np.arange(count) + 0.5) * length / count).astype(np.int64)
