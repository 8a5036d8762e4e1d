"""How dark strokes make each triangle: what its window on the tonal art map holds.

A tone is that of the whole map; the window of a small triangle may hold two strokes of it or none.
Where it is looked at on a screen the strokes' greys count: programs mix code values where a line
covers a part of a pixel, so a tone of an SVG is a mean of code values. A pen on paper has no greys,
and what is mixed there is light.
"""

from functools import cache

import numpy as np

from stages.exchange.plane.inks import LUMA, Inks
from warp_kernels.scene.places import hashes_of
from warp_kernels.scene.stroke_lay import Lay
from warp_kernels.scene.texels import Texels
from warp_kernels.styles.drawn import Drawn
from warp_kernels.styles.tones.lookup import SMALLEST, softened
from warp_kernels.styles.tones.strokes import SHARPNESS
from warp_kernels.styles.tones.tonal_art_map import (
    SPACING,
    TONE_STEP,
    TONES,
    Drawing,
    tonal_art_map,
)

LOOKS = 400
"""Places of each triangle that are looked at."""
PLASTIC = 1.324717957244746
"""Root of x^3 = x + 1: multiples of its powers fill a square evenly.

Source: Roberts, The unreasonable effectiveness of quasirandom sequences (2018).
"""
FAINTEST = 1.0
"""Code values between pen and paper; nearer ones are told apart by light."""


def seen_tones(ink: np.ndarray, inks: Inks) -> np.ndarray:
    """Part of each triangle that strokes of full strength cover where code values are mixed, [T].

    Args:
        ink: What lies at some places of each, 0 to 1, [T, N].
        inks: Pens and papers.
    """
    mean = np.zeros(len(ink))
    for channel, weight in enumerate(LUMA):
        pen, paper = (one[:, channel].astype(np.float64) for one in (inks.pens, inks.papers))
        light = paper[:, None] ** 2 + ink * (pen**2 - paper**2)[:, None]
        mean += weight * np.sqrt(np.maximum(light, 0.0)).mean(axis=1)
    pen, paper = (one @ LUMA for one in (inks.pens, inks.papers))
    is_clear = np.abs(paper - pen) >= FAINTEST
    share = (paper - mean) / np.where(is_clear, paper - pen, 1.0)
    return np.where(is_clear, np.clip(share, 0.0, 1.0), ink.mean(axis=1))


def drawn_ink(
    style: Drawn, corners: np.ndarray, lay: Lay, amounts: np.ndarray, pixel: float
) -> np.ndarray:
    """What the style draws at places all over each triangle, 0 to 1, [T, LOOKS].

    Args:
        style: Says how the strokes look.
        corners: Positions of the triangles [px], [T, 3, 2].
        lay: Where strokes lie on them.
        amounts: The tones that are asked for, [T].
        pixel: Size of a pixel of the output [px].
    """
    texels = SPACING / style.spacing
    level = max(0, int(np.ceil(np.log2(texels * pixel * SHARPNESS) - 0.5)))
    tones = _levels(type(style).drawing, style.weight, style.seed)
    ink = tones[min(level, len(tones) - 1)]
    side = ink.shape[1]
    columns, rows = _places(style, corners, lay, texels * side / tones[0].shape[1], side)
    tone = np.clip(amounts / TONE_STEP, 0.0, TONES - 1.0)
    lighter = np.minimum(np.floor(tone), TONES - 2.0).astype(np.int64)
    light, dark = (_bilinear(ink, lighter + darker, rows, columns) for darker in (0, 1))
    return np.asarray(light + (tone - lighter)[:, None] * (dark - light))


def _places(
    style: Drawn, corners: np.ndarray, lay: Lay, texels: float, side: int
) -> tuple[np.ndarray, np.ndarray]:
    """Where triangles are looked at, as columns and rows on the tile [texels], [T, LOOKS] each.

    Args:
        style: Says how the strokes look.
        corners: Positions of the triangles [px], [T, 3, 2].
        lay: Where strokes lie on them.
        texels: Texels for each px.
        side: Of the tile [texels].
    """
    steps = np.modf((np.arange(LOOKS) + 0.5)[:, None] / np.array([PLASTIC, PLASTIC**2]))[0]
    root = np.sqrt(steps[:, 0])
    weights = np.stack([1.0 - root, root * (1.0 - steps[:, 1]), root * steps[:, 1]])
    x, y = (corners[:, :, axis] @ weights - lay.places[:, axis, None] for axis in range(2))
    along = texels * lay.directions @ turned(style.angle)
    right, down = along[:, :1], along[:, 1:]
    hashes = (hashes_of(lay.owners) ^ np.uint32(style.seed)) * np.uint32(747796405)
    begins = (hashes >> np.uint32(23), hashes >> np.uint32(14) & np.uint32(511))
    column, row = ((begin * (side / 512.0))[:, None] - 0.5 for begin in begins)
    return x * right + y * down + column, y * right - x * down + row


def turned(angle: float) -> np.ndarray:
    """A matrix behind rows of vectors that turns them clockwise by an angle [degrees], [2, 2]."""
    turn = np.radians(angle)
    return np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])


def _bilinear(
    images: np.ndarray, numbers: np.ndarray, rows: np.ndarray, columns: np.ndarray
) -> np.ndarray:
    """Images that repeat, looked at between texels, [T, N].

    Args:
        images: The images, [I, side, side].
        numbers: Which one each row of places looks at, [T].
        rows: Places [texels], [T, N].
        columns: The same, to the right.
    """
    side = images.shape[1]
    flat, begins = images.reshape(-1), (numbers * side * side)[:, None]
    upper, left = np.floor(rows).astype(np.int64), np.floor(columns).astype(np.int64)
    down, right = rows - upper, columns - left
    found = np.zeros(rows.shape)
    for below, share in ((0, 1.0 - down), (1, down)):
        line = begins + (upper + below) % side * side
        found += share * (1.0 - right) * flat[line + left % side]
        found += share * right * flat[line + (left + 1) % side]
    return found


@cache
def _levels(drawing: Drawing, weight: float, seed: int) -> tuple[np.ndarray, ...]:
    """Ink of the tones, 0 to 1, [TONES, side, side] float32 for each level of detail."""
    levels = Texels.of(tonal_art_map(drawing, width=weight, grain=0.0, seed=seed)).levels
    kept = (softened(level) for level in levels if level.shape[1] >= SMALLEST)
    return tuple(np.float32(1.0) - level.astype(np.float32) / np.float32(255.0) for level in kept)
