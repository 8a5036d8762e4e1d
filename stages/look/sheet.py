"""Pictures side by side with a line of text below each."""

from collections.abc import Sequence

import cv2
import numpy as np

GAP = 12
"""White between pictures and around them [px]."""
CAPTION = 26
"""Height of a caption [px]."""
LETTERS = 0.42
"""Size of letters relative to that of the font."""
MARGIN = 1.25
"""How much wider letters may be drawn than they are said to be."""
INK = (40, 40, 40)
"""Colour of letters [code values]."""


def sheet_of(pictures: Sequence[np.ndarray], captions: Sequence[str], columns: int) -> np.ndarray:
    """Lay pictures out row by row on white.

    Args:
        pictures: Code values, [H, W, 3] uint8, all of one size.
        captions: A line for each; one that is too long is squeezed.
        columns: Pictures in a row.

    Returns:
        Code values, [rows, columns, 3] uint8.
    """
    height, width = pictures[0].shape[:2]
    rows = -(-len(pictures) // columns)
    size = (GAP + rows * (height + CAPTION + GAP), GAP + columns * (width + GAP), 3)
    sheet = np.full(size, 255, dtype=np.uint8)
    for number, (picture, caption) in enumerate(zip(pictures, captions, strict=True)):
        top = GAP + number // columns * (height + CAPTION + GAP)
        left = GAP + number % columns * (width + GAP)
        sheet[top : top + height, left : left + width] = picture
        _write(sheet, caption, (left, top + height + CAPTION - 8), width)
    return sheet


def of_width(pictures: Sequence[np.ndarray], width: int) -> list[np.ndarray]:
    """Pictures scaled to one width [px], and to the height that this gives the first one.

    Args:
        pictures: Code values, [H, W, 3] uint8.
        width: Columns of each.
    """
    rows, columns = pictures[0].shape[:2]
    size = (width, max(1, round(rows * width / columns)))
    return [cv2.resize(picture, size, interpolation=cv2.INTER_AREA) for picture in pictures]


def _write(sheet: np.ndarray, text: str, at: tuple[int, int], width: int) -> None:
    """Write a line that is at most so wide [px]."""
    font = cv2.FONT_HERSHEY_DUPLEX
    needed = MARGIN * cv2.getTextSize(text, font, LETTERS, 1)[0][0]
    size = LETTERS * min(1.0, width / max(1, needed))
    cv2.putText(sheet, text, at, font, size, INK, 1, cv2.LINE_AA)
