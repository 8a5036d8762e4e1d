"""The colours of a picture: a few that stand for all of it."""

import numpy as np

from stages.media import open_decoder
from stages.toning.oklab_colors import to_codes, to_lab
from stages.toning.palette import Color

SIDE = 128
"""At most so many rows and columns of the picture are looked at."""
ROUNDS = 24
"""Rounds in which the colours settle."""


def colors_of_picture(path: str, count: int) -> tuple[Color, ...]:
    """Find the colours of a picture, from dark to bright.

    The first ones are those that are farthest from all before them, weighed by how much of the
    picture they are; then each becomes the mean of what is nearest to it in Oklab. Nothing is drawn
    by lot.

    Args:
        path: What FFmpeg reads; its first frame counts.
        count: How many colours.

    Raises:
        MediaError: If it cannot be read.
    """
    with open_decoder(path) as decoder:
        pixels = next(decoder).pixels
    steps = [-(-side // SIDE) for side in pixels.shape[:2]]
    seen = pixels[:: steps[0], :: steps[1]].reshape(-1, 3)
    # 16 levels a channel: a flat sky is one colour that weighs much, and not thousands
    _, cells = np.unique(seen // 16 @ np.array([256, 16, 1]), return_inverse=True)
    weights = np.bincount(cells).astype(np.float64)
    means = [np.bincount(cells, seen[:, k]) / weights for k in range(3)]
    lab = to_lab(np.stack(means, axis=1))
    centres = _settled(lab, weights, _first(lab, weights, count))
    order = np.argsort(centres[:, 0], kind="stable")
    codes = np.clip(to_codes(centres[order]), 0.0, 255.0)
    return tuple((float(r), float(g), float(b)) for r, g, b in codes)


def _first(lab: np.ndarray, weights: np.ndarray, count: int) -> np.ndarray:
    """Colours to begin with, [count, 3]."""
    chosen = [int(weights.argmax())]
    away = np.full(len(lab), np.inf)
    for _ in range(count - 1):
        away = np.minimum(away, ((lab - lab[chosen[-1]]) ** 2).sum(axis=1))
        chosen.append(int((np.sqrt(weights) * away).argmax()))
    return lab[chosen]


def _settled(lab: np.ndarray, weights: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """Means of what is nearest to each of some colours; one that nothing is near to stays."""
    for _ in range(ROUNDS):
        away = ((lab[:, None] - centres[None]) ** 2).sum(axis=2)
        own = away.argmin(axis=1)
        sums = np.bincount(own, weights, len(centres))
        found = [np.bincount(own, weights * lab[:, k], len(centres)) for k in range(3)]
        means = np.stack(found, axis=1) / np.maximum(sums, 1e-9)[:, None]
        centres = np.where(sums[:, None] > 0, means, centres)
    return centres
