"""What pens and papers strokes are drawn with: `warp_kernels.styles.tones.strokes`, on the host."""

from dataclasses import dataclass

import numpy as np

from stages.exchange.figure import Figure
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.drawn import NO_PAPER, OWN_PAPER, SHEET, Drawn
from warp_kernels.styles.tones.strokes import BRIGHTEST, SATURATION, TINT, WHITE
from warp_kernels.styles.tones.tonal_art_map import DARKEST

LUMA = np.array([0.2126, 0.7152, 0.0722])
"""Weights of the channels in brightness."""


@dataclass(frozen=True, eq=False)
class Inks:
    """How triangles are drawn."""

    pens: np.ndarray
    """Colours of the strokes [code values], [T, 3] uint8."""
    papers: np.ndarray
    """Colours between them [code values], [T, 3] uint8."""
    amounts: np.ndarray
    """Part of the paper that strokes cover, 0 to `DARKEST`, [T]."""


def inks_of(style: Drawn, figure: Figure) -> Inks:
    """Pens, papers and tones of a frame.

    Args:
        style: Says how the strokes look.
        figure: The frame.
    """
    color = np.asarray(figure.paint.colors, dtype=np.float64)
    light = color * color
    sheet = {NO_PAPER: "#fff", OWN_PAPER: SHEET}.get(style.paper, style.paper)
    pen, paper = (np.square(parse_color(text)) for text in (style.ink, sheet))
    dark = 1.0 - color @ LUMA / 255.0
    amounts = dark * (1.0 - style.lighten + style.lighten * dark)
    pens = np.broadcast_to(pen, light.shape)
    papers = np.broadcast_to(paper, light.shape)
    if style.paper == OWN_PAPER:
        taken = style.contrast * light * (WHITE - pen) / WHITE
        papers = np.minimum(light + amounts[:, None] * taken, WHITE)
        pens = np.maximum(papers - taken, 0.0)
    if style.colored > 0.0:
        others = _pencils(light, paper)
        pens, papers, amounts = (
            one + style.colored * (other - one)
            for one, other in zip((pens, papers, amounts), others, strict=True)
        )
    pens, papers = (np.rint(np.sqrt(one)).astype(np.uint8) for one in (pens, papers))
    return Inks(pens, papers, np.clip(amounts, 0.0, DARKEST))


def _pencils(light: np.ndarray, sheet: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Light of a pencil and a paper for each triangle, and its tone.

    Args:
        light: Of the triangles, [T, 3].
        sheet: Of the paper, [3].
    """
    tinted = sheet + TINT * (light - sheet)
    brightest = BRIGHTEST * (light @ LUMA) / np.maximum(tinted @ LUMA, 1.0)
    papers = np.minimum(brightest, 1.0)[:, None] * tinted
    kept = light / np.maximum(papers, 1.0)
    least = 1.0 - np.minimum(kept.min(axis=1), 1.0)
    amounts = np.clip(least + SATURATION * (1.0 - least), 0.02, DARKEST)
    pens = np.maximum(papers - (papers - light) / amounts[:, None], 0.0)
    return pens, papers, amounts
