"""Pictures of other programs beside those that are drawn here."""

from pathlib import Path

import cv2
import numpy as np

ROOT = Path(__file__).parents[2]


def row(found: Path, own: Path, around: int) -> str:
    """How far a picture is from the drawn one, off the edges and in all.

    Args:
        found: What the other program shows.
        own: What is drawn.
        around: So many pixels to each side must have one colour where a pixel is off the edges.
    """
    drawn, shown = cv2.imread(str(own)), cv2.imread(str(found))
    if drawn.shape != shown.shape:
        return f"another size: {shown.shape[:2]} instead of {drawn.shape[:2]}"
    window = np.ones((2 * around + 1, 2 * around + 1), np.uint8)
    even = (cv2.dilate(drawn, window) == cv2.erode(drawn, window)).all(axis=2)
    even[[0, -1]] = even[:, [0, -1]] = False  # rays along the border may miss the picture
    off = np.abs(drawn.astype(int) - shown).max(axis=2)
    return (
        f"off edges ({100 * even.mean():.0f} % of the pixels) {off[even].max()} at most; "
        f"within 3 in {100 * (off <= 3).mean():.1f} % of all"
    )
