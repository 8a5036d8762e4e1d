"""Neighbours of one colour as one shape."""

from dataclasses import dataclass

import numpy as np

from stages.exchange.plane.areas import areas_of
from stages.exchange.svg.outlines import Trapped, outlines_of
from stages.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Merged:
    """Shapes of one or more triangles; a shape with holes has several lines."""

    outlines: Trapped
    """All lines, shape by shape."""
    spans: list[tuple[int, int]]
    """Begin and end of each shape's lines, [S]."""
    firsts: np.ndarray
    """The first triangle of each, ascending, [S]."""


def merged_outlines(mesh: Mesh, colors: np.ndarray) -> Merged:
    """Put neighbours of the same colour together.

    Args:
        mesh: The triangles.
        colors: Their colours, [T, 3] uint8.
    """
    areas = areas_of(mesh, colors)
    ends = np.cumsum(np.bincount(areas.loop_shapes)).tolist()
    _, firsts = np.unique(areas.shapes, return_index=True)
    spans = list(zip([0, *ends[:-1]], ends, strict=True))
    return Merged(outlines_of(mesh, areas.loops, areas.counts, areas.shapes), spans, firsts)
