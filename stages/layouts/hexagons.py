"""The hexagonal layout: equal triangles in rows, six around every point."""

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

    from stages.mesh import Mesh

NEAR = 4
"""So many columns and rows more or fewer are tried."""
ODD_SHAPE = 1.0
"""How much triangles that are no equal ones count beside a number that is missed."""


@dataclass(frozen=True)
class Hexagons:
    """A lattice of equal triangles whose rows are shifted by half a side."""

    def build(
        self, pixels: "np.ndarray", triangle_count: int, rng: "np.random.Generator"
    ) -> "Mesh":
        """Lay the lattice over a picture.

        Args:
            pixels: The picture, shape [H, W, 3] uint8; only its size matters.
            triangle_count: Wanted number of triangles; met as nearly as rows and columns allow.
            rng: Not used.
        """
        import numpy as np

        from stages.layouts.even_points import bounded_count, delaunay_mesh

        height, width = pixels.shape[:2]
        columns, rows = _lattice(width, height, bounded_count(pixels, triangle_count))
        y, odd = np.linspace(0, height, rows + 1), np.arange(rows + 1) % 2 == 1
        whole = np.linspace(0, width, columns + 1)
        between = (np.arange(columns) + 0.5) * (width / columns)
        lines = [between if is_odd else whole for is_odd in odd]
        x = np.concatenate(lines)
        points = np.stack([x, np.repeat(y, [len(line) for line in lines])], axis=1)
        corners = np.array([[0, 0], [width, 0], [0, height], [width, height]], dtype=np.float64)
        is_corner = (points[:, None] == corners[None]).all(axis=2).any(axis=1)
        return delaunay_mesh(np.concatenate([corners, points[~is_corner]]), width, height)


def _lattice(width: int, height: int, count: int) -> tuple[int, int]:
    """Columns and rows whose number of triangles and shape are right."""
    side = sqrt(4 / sqrt(3) * width * height / count)
    best, least = (1, 1), float("inf")
    for columns in _around(width / side):
        for rows in _around(height / (side * sqrt(3) / 2)):
            shape = (height / rows) / (width / columns * sqrt(3) / 2)
            missed = abs(_triangles(columns, rows) - count) / count
            cost = missed + ODD_SHAPE * abs(shape - 1 if shape > 1 else 1 / shape - 1)
            cost += 100.0 * max(0.0, missed - 0.08) * (abs(_triangles(columns, rows) - count) > 2)
            if cost < least:
                best, least = (columns, rows), cost
    return best


def _around(exact: float) -> range:
    return range(max(1, round(exact) - NEAR), max(1, round(exact) + NEAR) + 1)


def _triangles(columns: int, rows: int) -> int:
    """Triangles of a lattice: I inner and B border points make 2 I + B - 2."""
    whole = (rows - 1) // 2  # lines of points inside that are not shifted, and end on the border
    shifted = rows - 1 - whole
    border = 2 * columns + 2 + rows % 2 + 2 * whole
    return 2 * (whole * (columns - 1) + shifted * columns) + border - 2
