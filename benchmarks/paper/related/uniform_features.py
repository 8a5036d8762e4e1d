"""Feature points at nearly equal distances: Conceptfarm's Triangulate."""

from dataclasses import dataclass

import cv2
import numpy as np

from benchmarks.paper.related.counting import mesh_of_count
from benchmarks.paper.related.detail import luma, pixels_anywhere, positions
from benchmarks.paper.related.spacing import apart
from stages.mesh import Mesh

CLOSENESS = 0.65
"""Distance that points keep, in distances of an even spread: a guess that is corrected [1]."""
FILLING = 1.4
"""Distance that points keep which fill places without corners, in distances of corners [1]."""


@dataclass(frozen=True)
class UniformFeatures:
    """Delaunay triangles over the best corners that keep a distance.

    Source: Conceptfarm, Triangulate (2016), as Lawonn & Guenther (2018), Sec. 2.1 and 6.1,
        describe it: the blur preserves edges, feature points lie uniformly, triangles are of
        roughly equal size.
    Deviation: the corners are those of Shi & Tomasi.
    """

    def build(self, pixels: np.ndarray, triangle_count: int, rng: np.random.Generator) -> Mesh:
        """Triangulate a picture [H, W, 3] uint8 with about `triangle_count` triangles."""
        size = (pixels.shape[1], pixels.shape[0])
        corners = _corners(cv2.bilateralFilter(luma(pixels), 7, 30, 5))
        order = np.concatenate([corners, pixels_anywhere(size, rng)])
        is_corner = np.arange(len(order)) < len(corners)
        chance = rng.integers(2**32)

        def place(count: float) -> np.ndarray:
            """The corners, and points where there is none near."""
            spacing = CLOSENESS * np.sqrt(size[0] * size[1] / count)
            radii = np.where(is_corner, spacing, FILLING * spacing)
            served = apart(order, radii, size, len(order))
            return positions(order[served], np.random.default_rng(chance))

        return mesh_of_count(place, triangle_count, size)


def _corners(grey: np.ndarray) -> np.ndarray:
    """Pixels (column, row) where the corner response has a maximum, best first, [N, 2]."""
    response = cv2.cornerMinEigenVal(grey, 3)
    peaks = (response >= cv2.dilate(response, np.ones((3, 3)))) & (response > 0)
    rows, columns = np.nonzero(peaks)
    order = np.argsort(-response[rows, columns], kind="stable")
    return np.stack([columns, rows], axis=1)[order]
