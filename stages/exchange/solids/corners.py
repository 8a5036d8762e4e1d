"""Triangles as 3D programs want them: corners of their own, so that each can have its colour."""

from dataclasses import dataclass

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.solids.heights import heights_of
from stages.masks.gray import LUMA
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
    places, colors = vertex_places(figure, film), corner_colors(figure, film)
    points = places.take(figure.mesh.triangles[:, [0, 2, 1]], axis=0)
    return Corners(points, colors[:, [0, 2, 1]])


def vertex_places(figure: Figure, film: Film) -> np.ndarray:
    """Positions of the vertices, right, up and towards the viewer [px], [V, 3] float32."""
    mesh, relief = figure.mesh, film.options.heights
    x, y = mesh.vertices.T
    z = np.zeros_like(x)
    if relief is not None:
        z = heights_of(relief, mesh, corner_colors(figure, film) @ np.array(LUMA) / 255.0)
    return np.stack([x, film.size[1] - y, z], axis=1).astype(np.float32)


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
