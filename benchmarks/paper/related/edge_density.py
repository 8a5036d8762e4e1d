"""Vertices as dense as edges are strong: Hamamuro's tool."""

from dataclasses import dataclass

import numpy as np

from benchmarks.paper.related.counting import mesh_of_count
from benchmarks.paper.related.detail import drawn_by, gradient, positions
from benchmarks.paper.related.spacing import apart
from stages.mesh import Mesh

CANDIDATES = 8
"""Pixels drawn for each vertex wanted: some lie too close to others."""


@dataclass(frozen=True)
class EdgeDensity:
    """Delaunay triangles over points drawn by the strength of the gradient.

    Source: Hamamuro (2012), as Lawonn & Guenther (2018), Sec. 2.1 and 6.1, describe it: many
        small triangles along edges, a coarse triangulation in large smooth areas.
    """

    blur: float = 3.0
    """Standard deviation of the smoothing before the gradient [px]."""
    sharpness: float = 2.5
    """Power of the gradient by which points are drawn [1]."""
    floor: float = 1e-3
    """Least weight of a pixel, in weights of the strongest [1]."""

    def build(self, pixels: np.ndarray, triangle_count: int, rng: np.random.Generator) -> Mesh:
        """Triangulate a picture [H, W, 3] uint8 with about `triangle_count` triangles."""
        size = (pixels.shape[1], pixels.shape[0])
        strength = gradient(pixels, self.blur) ** self.sharpness
        weights = strength / max(float(np.quantile(strength, 0.995)), 1e-9)
        weights = weights.clip(0, 1) + self.floor
        drawn = drawn_by(weights, CANDIDATES * triangle_count, rng)
        chance = rng.integers(2**32)

        def place(count: float) -> np.ndarray:
            """Those of the pixels drawn that keep a distance."""
            closest = 0.25 * np.sqrt(size[0] * size[1] / count)
            served = apart(drawn, closest, size, max(1, round(count)))
            return positions(drawn[served], np.random.default_rng(chance))

        return mesh_of_count(place, triangle_count, size)
