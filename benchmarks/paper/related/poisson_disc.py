"""Poisson discs whose radius shrinks with the detail: Polyshaper."""

from dataclasses import dataclass

import numpy as np

from benchmarks.paper.related.counting import mesh_of_count
from benchmarks.paper.related.detail import gradient, pixels_anywhere, positions
from benchmarks.paper.related.spacing import apart
from stages.mesh import Mesh


@dataclass(frozen=True)
class PoissonDisc:
    """Delaunay triangles over a Poisson-disc sampling.

    Source: Marin, Polyshaper (2016), as Lawonn & Guenther (2018), Sec. 2.1, describe it.
    Deviation: the radius follows the detail, which lowers the error.
    """

    blur: float = 8.0
    """Standard deviation of the smoothing before the gradient [px]."""
    contrast: float = 3.0
    """Largest radius over the smallest [1]."""

    def build(self, pixels: np.ndarray, triangle_count: int, rng: np.random.Generator) -> Mesh:
        """Triangulate a picture [H, W, 3] uint8 with about `triangle_count` triangles."""
        width, height = size = (pixels.shape[1], pixels.shape[0])
        strength = gradient(pixels, self.blur)
        detail = (strength / max(float(np.quantile(strength, 0.98)), 1e-9)).clip(0, 1)
        radii = (1 / self.contrast) ** np.sqrt(detail)
        order = pixels_anywhere(size, rng)
        radii = radii[order[:, 1], order[:, 0]]
        mean = np.sqrt(1 / np.mean(1 / radii**2))
        chance = rng.integers(2**32)

        def place(count: float) -> np.ndarray:
            """Discs of the size that fits as many."""
            scale = 0.75 * np.sqrt(width * height / count) / mean
            served = apart(order, scale * radii, size, len(order))
            return positions(order[served], np.random.default_rng(chance))

        return mesh_of_count(place, triangle_count, size)
