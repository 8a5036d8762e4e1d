"""The Poisson layout: points by lot that keep a distance."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

    from stages.mesh import Mesh

DRAWN = 6
"""Points drawn for each one that is missing."""
SHRINK = 0.97
"""What becomes of the distance where a round found too little room."""


@dataclass(frozen=True)
class Poisson:
    """Points by lot, none of them near another: even, and without any direction.

    Source: Cook, Stochastic sampling in computer graphics (1986).
    Deviation: the distance shrinks until the wanted number has room, so that it is met exactly.
    """

    def build(
        self, pixels: "np.ndarray", triangle_count: int, rng: "np.random.Generator"
    ) -> "Mesh":
        """Draw the points and triangulate them.

        Args:
            pixels: The picture, shape [H, W, 3] uint8; only its size matters.
            triangle_count: Wanted number of triangles; odd ones are missed by one at most.
            rng: Source of the draws.
        """
        from stages.layouts.even_points import (
            border_points,
            bounded_count,
            delaunay_mesh,
            even_spacing,
        )

        height, width = pixels.shape[:2]
        count = bounded_count(pixels, triangle_count)
        spacing = even_spacing(width, height, count)
        border = border_points(width, height, spacing)
        inner = max(0, (count + 2 - len(border) + 1) // 2)
        points = scattered(border, inner, spacing, (width, height), rng)
        return delaunay_mesh(points, width, height)


def scattered(
    points: "np.ndarray",
    count: int,
    spacing: float,
    size: tuple[int, int],
    rng: "np.random.Generator",
) -> "np.ndarray":
    """Add points by lot that keep as large a distance as there is room for.

    Args:
        points: Points that there are, [N, 2] [px].
        count: How many are added, if there is any room.
        spacing: Distance that is tried first [px].
        size: Width and height of the picture [px].
        rng: Source of the draws.

    Returns:
        The points, then the new ones, [N + count or fewer, 2].
    """
    import numpy as np
    from scipy.spatial import cKDTree

    from stages.layouts.even_points import CLOSEST, MARGIN, apart

    whole = len(points) + count
    while len(points) < whole and spacing > CLOSEST:
        missing = whole - len(points)
        drawn = rng.random((DRAWN * missing + 8, 2)) * size
        margin = MARGIN * min(spacing, 0.5 * min(size))
        drawn = drawn[((drawn > margin) & (drawn < np.array(size) - margin)).all(axis=1)]
        if len(drawn):
            drawn = drawn[cKDTree(points).query(drawn)[0] >= spacing]
        found = apart(drawn, spacing)[:missing] if len(drawn) else drawn
        points = np.concatenate([points, found])
        if len(found) < 0.02 * missing + 1:
            spacing *= SHRINK
    return points
