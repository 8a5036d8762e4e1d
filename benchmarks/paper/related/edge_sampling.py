"""Vertices sampled on detected edges, and some at random: Borquez' tool and Dmesh."""

from dataclasses import dataclass

import numpy as np

from benchmarks.paper.related.counting import mesh_of_count
from benchmarks.paper.related.detail import edges, pixels_anywhere, pixels_where, positions
from benchmarks.paper.related.spacing import apart
from stages.mesh import Mesh


@dataclass(frozen=True)
class EdgeSampling:
    """Delaunay triangles over points on Canny's edges.

    Source: Borquez (2017) and Yun, Dmesh (2013), as Lawonn & Guenther (2018), Sec. 2.1 and 6.1,
        describe them: edges are detected, vertices placed on them, strong edges preferred.
    Deviation: points on edges keep a distance, which the tools leave to chance; it lowers the
        error, and the comparison is to be fair.
    """

    blur: float = 4.0
    """Standard deviation of the smoothing before the edges are detected [px]."""
    edge_share: float = 0.15
    """Part of the pixels whose gradient is strong."""
    random_share: float = 0.1
    """Part of the vertices that is spread over the whole picture."""

    def build(self, pixels: np.ndarray, triangle_count: int, rng: np.random.Generator) -> Mesh:
        """Triangulate a picture [H, W, 3] uint8 with about `triangle_count` triangles."""
        size = (pixels.shape[1], pixels.shape[0])
        mask = edges(pixels, self.blur, self.edge_share)
        on_edges = pixels_where(mask, rng)
        anywhere = pixels_anywhere(size, rng)
        chance = rng.integers(2**32)

        def place(count: float) -> np.ndarray:
            """Points on edges, then points anywhere."""
            wanted = min(round((1 - self.random_share) * count), len(on_edges))
            spacing = 0.5 * len(on_edges) / max(wanted, 1)
            chosen = on_edges[apart(on_edges, spacing, size, wanted)]
            order = np.concatenate([chosen, anywhere])
            free = 0.7 * np.sqrt(size[0] * size[1] / count)
            radii = np.where(np.arange(len(order)) < len(chosen), 0.4 * spacing, free)
            both = apart(order, radii, size, max(1, round(count)))
            return positions(order[both], np.random.default_rng(chance))

        return mesh_of_count(place, triangle_count, size)
