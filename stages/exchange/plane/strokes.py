"""Hatching as strokes of pens: lines of one width, as near to each other as the tone asks for."""

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.plane.hatch import Segments, hatched
from stages.exchange.plane.inks import Inks
from stages.exchange.plane.tones import drawn_ink, seen_tones
from warp_kernels.scene.stroke_lay import own_lay
from warp_kernels.styles.drawn import Drawn
from warp_kernels.styles.tones.ruling import ACROSS, FALLING, RISING, SLANTED, Direction

LINES: dict[str, tuple[Direction, ...]] = {
    "hatching": (ACROSS,),
    "crosshatching": (ACROSS, FALLING, RISING, SLANTED),
}
"""In which directions styles draw lines: along the base edge, and across the darker it is."""
PENS = 32
"""So many colours at most have a layer each."""
DENSEST = 0.3
"""Part of the paper that lines of one direction cover before others cross them."""
SHIFTS = (0.0, 0.5, 0.25, 0.75)
"""How far lines of each direction lie aside [distances]: they cross all over small triangles."""


def strokes_of(
    style: Drawn, figure: Figure, film: Film, inks: Inks, directions: tuple[Direction, ...]
) -> Segments:
    """The strokes of every triangle.

    Args:
        style: Says how strokes look.
        figure: The frame.
        film: What all frames have in common.
        inks: Pens and papers of the frame.
        directions: Those of the lines, the first first.
    """
    pixel, is_paper = 1.0 / film.scale[0], film.is_on_paper
    mesh = figure.mesh
    lay = figure.paint.lay or own_lay(mesh.triangle_ids, mesh.corners)
    ink = drawn_ink(style, mesh.corners, lay, inks.amounts, pixel)
    tones = ink.mean(axis=1) if is_paper else seen_tones(ink, inks)
    # what lines that know nothing of each other leave blank is a product: its logarithm is shared
    depths, most = -np.log1p(-np.minimum(tones, 0.99)), -np.log1p(-DENSEST)
    shares = np.clip(depths - most * np.arange(len(directions))[:, None], 0.0, most)
    shares = np.maximum(shares, (depths > most * len(directions)) * depths / len(directions))
    parts = []
    for direction, shift, share in zip(directions, SHIFTS, shares, strict=False):
        slant = np.arctan2(1.0, direction.slope) if direction.steep else np.arctan(direction.slope)
        covered = -np.expm1(-share)
        width = style.weight * style.spacing
        turn = style.angle + np.degrees(slant)
        parts.append(hatched(mesh.corners, lay, turn, shift, covered, width))
    triangles = np.concatenate([part.triangles for part in parts])
    order = np.argsort(triangles, kind="stable")
    return Segments(triangles[order], np.concatenate([part.ends for part in parts])[order])
