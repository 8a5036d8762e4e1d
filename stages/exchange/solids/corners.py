"""Triangles as 3D programs want them: corners of their own, so that each can have its colour."""

from dataclasses import dataclass

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from warp_kernels.errors import OptionError

HELD = ("flat", "gradient")
"""Styles that colours at corners can hold."""


@dataclass(frozen=True, eq=False)
class Corners:
    """All corners of a frame, counter-clockwise as seen from the front."""

    points: np.ndarray
    """Positions, right, up and towards the viewer [px], [T, 3, 3] float32."""
    colors: np.ndarray
    """Colours [code values], [T, 3, 3] float32."""


def corners_of(figure: Figure, film: Film) -> Corners:
    """The corners of a frame.

    Args:
        figure: The frame.
        film: Tells whether colours are even or gradients.
    """
    flat = figure.mesh.corners[:, [0, 2, 1]]
    height = np.zeros((*flat.shape[:2], 1))
    points = np.concatenate([flat[..., :1], film.size[1] - flat[..., 1:], height], axis=2)
    return Corners(points.astype(np.float32), corner_colors(figure, film)[:, [0, 2, 1]])


def corner_colors(figure: Figure, film: Film) -> np.ndarray:
    """Colours at the corners, in the order of the mesh [code values], [T, 3, 3] float32."""
    paint = figure.paint
    if film.styles[-1].degree == 0:
        return np.repeat(paint.colors[:, None], 3, axis=1).astype(np.float32)
    away = paint.corners - paint.corners.mean(axis=1, keepdims=True)
    found = paint.colors[:, None] + np.einsum("tcd,tdk->tck", away, paint.gradients)
    limits = paint.limits[:, :, None]
    return np.clip(found, limits[:, 0], limits[:, 1]).astype(np.float32)


def refuse_stacks(film: Film) -> None:
    """Refuse what colours at corners cannot hold.

    Args:
        film: What is wanted.

    Raises:
        OptionError: If there is more than one style, or one that is not opaque.
    """
    style = film.styles[-1]
    if len(film.styles) > 1 or not style.hides_below:
        raise OptionError(
            f"--style: {film.ending} holds one opaque style; choose flat or gradient alone, or .png"
        )
