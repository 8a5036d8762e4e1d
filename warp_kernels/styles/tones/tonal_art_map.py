"""Tones of hatching that hold each other: every stroke of a lighter one is in all darker ones.

Source: Praun, Hoppe, Webb & Finkelstein, Real-time hatching (2001), Sec. 4: tonal art maps;
    Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 7.
Deviation: coarser levels of detail are means of the finer ones instead of drawings of their own:
    strokes have a width in the picture, not on the screen, and a picture that is drawn smaller
    shall look like the larger one from further away.
"""

from collections.abc import Callable, Iterator

import numpy as np

from warp_kernels.styles.tones.ruling import (
    ACROSS,
    FALLING,
    RISING,
    SIDE,
    SLANTED,
    Inking,
    Ruling,
    Touch,
)

TONES = 9
"""Tones, the blank paper among them."""
TONE_STEP = 29 / 255
"""Ink that each tone has more than the one before; whole code values, so that no tone is rounded
where a level of detail is a single texel."""
DARKEST = (TONES - 1) * TONE_STEP
"""Ink of the darkest tone, as a part of the paper; slivers of it stay blank, as in a drawing."""
SPACING = 8.0
"""Distance of the lines [texels]; a tile is 64 of them wide."""
ROUGHNESS = 150.0
"""Waves of the paper's tooth along a tile, up to about."""

Drawing = Callable[[np.random.Generator, float, np.ndarray | None], Iterator[Inking]]
"""Endless strokes, the lightest tone's first; takes a source of chance, the width of thin lines
[spacings] and the tooth of the paper."""


def grown(width: float, growth: float) -> float:
    """Width of lines that have grown from a thin one (0) to their distance (1) [spacings]."""
    return width + growth * (1.0 - width)


def parallel_strokes(
    rng: np.random.Generator, width: float, tooth: np.ndarray | None
) -> Iterator[Inking]:
    """Lines along the base edge: more of them, then thicker ones."""
    lines = Ruling(rng, ACROSS, SPACING)
    for growth, pressure in ((0.0, 0.85), (0.2, 0.9)):
        for begin in (0.0, 0.5):
            touch = Touch(grown(width, growth), pressure, begin, begin + 0.5)
            yield from lines.strokes(rng, touch, tooth)
    for growth in (0.45, 0.65, 0.85):
        yield from lines.strokes(rng, Touch(grown(width, growth), 0.95), tooth)
    while True:
        yield from lines.strokes(rng, Touch(1.0, 1.0), tooth)


def crossing_strokes(
    rng: np.random.Generator, width: float, tooth: np.ndarray | None
) -> Iterator[Inking]:
    """Lines along the base edge, then across them in three more directions, then between them."""
    first, across, back, slanted = (
        Ruling(rng, direction, SPACING, uneven=0.1)
        for direction in (ACROSS, FALLING, RISING, SLANTED)
    )
    between, across_between, back_between = (
        Ruling(rng, direction, SPACING, shift=0.5, uneven=0.1)
        for direction in (ACROSS, FALLING, RISING)
    )
    for lines, begin, end, growth in (
        (first, 0.0, 0.5, 0.0),
        (first, 0.5, 1.0, 0.0),
        (across, 0.0, 0.5, 0.0),
        (across, 0.5, 1.0, 0.0),
        (back, 0.0, 0.5, 0.0),
        (between, 0.0, 1.0, 0.0),
        (back, 0.5, 1.0, 0.0),
        (across_between, 0.0, 1.0, 0.03),
        (slanted, 0.0, 1.0, 0.05),
        (back_between, 0.0, 1.0, 0.05),
        (first, 0.0, 1.0, 0.2),
        (across, 0.0, 1.0, 0.2),
        (back, 0.0, 1.0, 0.2),
        (between, 0.0, 1.0, 0.25),
        (across_between, 0.0, 1.0, 0.25),
    ):
        touch = Touch(grown(width, growth), 0.9, begin, end)
        yield from lines.strokes(rng, touch, tooth)
    while True:
        yield from first.strokes(rng, Touch(1.0, 1.0), tooth)


def tonal_art_map(drawing: Drawing, *, width: float, grain: float, seed: int) -> np.ndarray:
    """Draw strokes until each tone has its ink; the stroke that would exceed it is drawn fainter.

    Args:
        drawing: Gives the strokes.
        width: Of thin lines [spacings].
        grain: How rough the paper is, 0 (ink) to 1 (soft pencil).
        seed: Chooses one of many drawings.

    Returns:
        Brightness, 0 (ink) to 1 (paper), [TONES, SIDE, SIDE] float32, the lightest first.
    """
    rng = np.random.default_rng(seed)
    tooth = _tooth(rng, grain) if grain > 0.0 else None
    paper = np.ones(SIDE * SIDE, dtype=np.float32)
    tones = [paper.copy()]
    inked = 0.0
    for texels, ink in drawing(rng, width, tooth):
        under = paper[texels]
        covered = under * ink
        amount = float(covered.sum(dtype=np.float64)) / paper.size
        while inked + amount >= len(tones) * TONE_STEP:
            tone = paper.copy()
            tone[texels] = under - covered * np.float32((len(tones) * TONE_STEP - inked) / amount)
            tones.append(tone)
            if len(tones) == TONES:
                return np.stack(tones).reshape(TONES, SIDE, SIDE)
        paper[texels] = under - covered
        inked += amount
    raise AssertionError("a drawing ended before it was dark")


def _tooth(rng: np.random.Generator, grain: float) -> np.ndarray:
    """Heights of rough paper, 0 to 1, a tile of smooth noise; [SIDE * SIDE] float32."""
    waves = np.fft.fftfreq(SIDE) * SIDE
    lengths = np.hypot(waves[:, None], waves[: SIDE // 2 + 1])
    spectrum = np.fft.rfft2(rng.standard_normal((SIDE, SIDE)))
    spectrum *= np.exp(-((lengths / ROUGHNESS) ** 2)) * (lengths > 4)
    noise = np.fft.irfft2(spectrum, s=(SIDE, SIDE))
    heights = np.clip(grain * (0.45 + 0.3 * noise / noise.std()), 0.0, 0.85)
    return heights.astype(np.float32).reshape(-1)
