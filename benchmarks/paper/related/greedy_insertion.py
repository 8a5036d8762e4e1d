"""Greedy insertion: a vertex into the triangle of the largest error, until there are enough."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import islice

import cv2
import numpy as np

from benchmarks.paper.related.counting import border_points, delaunay_mesh
from benchmarks.paper.related.detail import gradient
from stages.mesh import Mesh
from stages.optimize import load_mesh
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device
from warp_kernels.energy.workspace import Workspace

LEAST_HEIGHT = 1.0
"""Vertices are inserted at least this far from the sides of a triangle [px]."""

Appeal = Callable[[np.ndarray, np.ndarray], np.ndarray | None]
"""From corners [px, 3 x 2] and colour [code values, 3] to the position of a vertex [px, 2]."""


@dataclass(frozen=True)
class GreedyInsertion:
    """Delaunay triangles refined where their best constant colours err most.

    Source: Garland & Heckbert, Fast polygonal approximation of terrains and height fields (1995),
        with constant colours for planes; Cohen, Dyn, Hecht & Mirebeau (2011) refine likewise.
    Deviation: a few vertices are inserted at a time. A pixel's error is that of its surroundings,
        or noise would attract the vertices.
    """

    blur: float = 1.0
    """Standard deviation of the surroundings of a pixel [px]."""
    growth: float = 0.04
    """Part of the triangles that get a vertex at a time."""

    def build(self, pixels: np.ndarray, triangle_count: int, rng: np.random.Generator) -> Mesh:
        """Triangulate a picture [H, W, 3] uint8 with about `triangle_count` triangles."""
        size = (pixels.shape[1], pixels.shape[0])
        workspace = Workspace(Device("cpu", 1), size, COLOR_MODELS["constant"])
        workspace.load_image(pixels)
        appeal = self.appeal(pixels)
        mesh = delaunay_mesh(border_points(triangle_count, size), size)
        while (missing := (triangle_count - mesh.triangle_count) // 2) > 0:
            load_mesh(workspace, mesh)
            colors, energies, _ = workspace.fit()
            most = min(missing, max(1, int(self.growth * mesh.triangle_count)))
            worst = np.argsort(-energies, kind="stable")
            corners = mesh.vertices[mesh.triangles[worst]]
            found = map(appeal, corners, colors[worst, :, 0])
            points = list(islice((point for point in found if point is not None), most))
            if not points:
                break  # no triangle that errs has room for a vertex
            mesh = delaunay_mesh(np.concatenate([mesh.vertices, points]), size)
        return mesh

    def appeal(self, pixels: np.ndarray) -> "Appeal":
        """Of a triangle the pixel that differs most from its colour."""
        smooth = cv2.GaussianBlur(pixels, (0, 0), self.blur).astype(np.float32)

        def worst_pixel(corners: np.ndarray, color: np.ndarray) -> np.ndarray | None:
            """The pixel whose surroundings differ most."""
            block, within = block_around(smooth, corners), heights_within(corners)
            return best_pixel(
                np.where(within > LEAST_HEIGHT, ((block - color) ** 2).sum(axis=2), -1), corners
            )

        return worst_pixel


@dataclass(frozen=True)
class SteepestInsertion(GreedyInsertion):
    """Greedy insertion strengthened: vertices go to where the gradient is steep.

    Deviation: of our own; constant colours want their vertices on the outlines, and the worst
        pixel lies within the wrong colour instead.
    """

    blur: float = 2.0
    """Standard deviation of the smoothing before the gradient [px]."""

    def appeal(self, pixels: np.ndarray) -> "Appeal":
        """Of a triangle the pixel with a steep gradient and far from the sides."""
        steepness = gradient(pixels, self.blur)

        def steepest_pixel(corners: np.ndarray, color: np.ndarray) -> np.ndarray | None:
            """The pixel of the largest gradient times root of the distance to the sides."""
            within = heights_within(corners)
            values = block_around(steepness, corners) * np.sqrt(within.clip(0))
            return best_pixel(np.where(within > LEAST_HEIGHT, values, -1), corners)

        return steepest_pixel


def block_around(values: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """The part of an image [H, W, ..] around a triangle's corners [px, 3 x 2]."""
    low, high = _bounds(corners)
    return values[low[1] : high[1], low[0] : high[0]]


def heights_within(corners: np.ndarray) -> np.ndarray:
    """Distance of each pixel around a triangle to its nearest side [px], not positive outside."""
    low, high = _bounds(corners)
    x, y = np.meshgrid(*(np.arange(a, b) + 0.5 for a, b in zip(low, high, strict=True)))
    nearest = np.full(x.shape, np.inf)
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        distance = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / np.hypot(bx - ax, by - ay)
        nearest = np.minimum(nearest, distance)
    return nearest


def best_pixel(values: np.ndarray, corners: np.ndarray) -> np.ndarray | None:
    """Middle of the pixel of the largest value [px, 2], or None where none is above 0.

    Args:
        values: Of the pixels around a triangle.
        corners: Of the triangle [px], [3, 2].
    """
    if not values.size or values.max() <= 0:
        return None
    row, column = np.unravel_index(values.argmax(), values.shape)
    return _bounds(corners)[0] + (column + 0.5, row + 0.5)


def _bounds(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First column and row around a triangle, and those past the last."""
    return np.floor(corners.min(axis=0)).astype(int), np.ceil(corners.max(axis=0)).astype(int)
