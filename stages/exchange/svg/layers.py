"""One style as a layer of shapes: which function draws which style."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.svg.text import hexes
from warp_kernels.registry import imported
from warp_kernels.styles import STYLES, Style


@dataclass(frozen=True)
class Layer:
    """What a style adds to a document."""

    elements: list[str]
    """Bottom to top."""
    definitions: list[str]
    """Gradients and the like that they use."""
    notes: tuple[str, ...] = ()
    """What is told of it, one sentence each."""


Drawn = Callable[[Style, Figure, Film, str], Layer]
"""Draws a style; the text is the begin of the ids of its elements."""

LAYERS = {
    "circles": "stages.exchange.svg.discs:circles",
    "crosshatching": "stages.exchange.svg.strokes:crosshatching",
    "edges": "stages.exchange.svg.lines:edges",
    "flat": "stages.exchange.svg.faces:flat",
    "gradient": "stages.exchange.svg.gradients:gradient",
    "hatching": "stages.exchange.svg.strokes:hatching",
    "incircles": "stages.exchange.svg.discs:incircles",
    "paper": "stages.exchange.svg.faces:paper",
    "shrink": "stages.exchange.svg.rounded:shrunk",
}
"""Where the functions are, by the styles' names."""


def layer_of(style: Style, figure: Figure, film: Film, name: str) -> Layer:
    """Draw a style.

    Args:
        style: One of `LAYERS`.
        figure: The frame.
        film: What all frames have in common.
        name: Begin of the ids of its elements.
    """
    draw: Drawn = imported(LAYERS[STYLES.name_of(type(style))])
    return draw(style, figure, film, name)


def ground_of(figure: Figure) -> str:
    """A sheet below triangles, in their mean colour: what little shines through is near to it.

    Args:
        figure: The frame.
    """
    return sheet_of(figure, figure.mean_color)


def sheet_of(figure: Figure, color: np.ndarray) -> str:
    """A sheet of the picture's size.

    Args:
        figure: The frame.
        color: Its colour [code values], [3].
    """
    mesh, shown = figure.mesh, hexes(np.rint(color).astype(np.uint8)[None])[0]
    return f'<rect class="ground" width="{mesh.width}" height="{mesh.height}" fill="{shown}"/>'
