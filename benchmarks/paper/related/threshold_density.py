"""Fine where the gradient exceeds a threshold, coarse elsewhere: Fischer's tool."""

from dataclasses import dataclass

import cv2
import numpy as np

from benchmarks.paper.related.counting import mesh_of_count
from benchmarks.paper.related.detail import gradient, pixels_where, positions
from benchmarks.paper.related.spacing import apart
from stages.mesh import Mesh


@dataclass(frozen=True)
class ThresholdDensity:
    """Delaunay triangles over a fine sampling of the focus and a coarse grid of the rest.

    Source: Fischer (2016), as Lawonn & Guenther (2018), Sec. 2.1 and 6.1, describe it: a threshold
        distinguishes a finely tessellated focus region from a very coarse context.
    """

    blur: float = 3.0
    """Standard deviation of the smoothing before the gradient [px]."""
    focus: float = 0.15
    """Part of the pixels whose gradient exceeds the threshold."""
    coarse_share: float = 0.2
    """Part of the vertices that the grid of the context takes."""

    def build(self, pixels: np.ndarray, triangle_count: int, rng: np.random.Generator) -> Mesh:
        """Triangulate a picture [H, W, 3] uint8 with about `triangle_count` triangles."""
        width, height = size = (pixels.shape[1], pixels.shape[0])
        strength = gradient(pixels, self.blur)
        mask = strength > max(1.0, float(np.quantile(strength, 1 - self.focus)))
        mask = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((3, 3))) > 0
        focus = pixels_where(mask, rng)
        chance = rng.integers(2**32)

        def place(count: float) -> np.ndarray:
            """The grid first, then the focus."""
            step = np.sqrt(width * height / max(1.0, self.coarse_share * count))
            x, y = (np.arange(step / 2, side - 1, step) for side in size)
            grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2).astype(np.int64)
            order = np.concatenate([grid, focus])
            radius = 0.7 * np.sqrt(len(focus) / max(1.0, (1 - self.coarse_share) * count))
            served = apart(order, radius, size, max(1, round(count)))
            return positions(order[served], np.random.default_rng(chance))

        return mesh_of_count(place, triangle_count, size)
