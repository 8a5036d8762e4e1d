"""The regular layout: nearly square cells, each cut from bottom left to top right."""

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

    from stages.mesh import Mesh


@dataclass(frozen=True)
class Grid:
    """A regular grid, so that no inner vertex has more than six neighbours.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.3.
    """

    def build(
        self, pixels: "np.ndarray", triangle_count: int, rng: "np.random.Generator"
    ) -> "Mesh":
        """Lay the grid over a picture; base edges are horizontal.

        Args:
            pixels: The picture, shape [H, W, 3] uint8; only its size matters.
            triangle_count: Wanted number of triangles; no cell is smaller than a pixel.
            rng: Not used.
        """
        import numpy as np

        from stages.mesh import mesh_of

        height, width = pixels.shape[:2]
        columns, rows = _cells(width, height, triangle_count)
        x, y = np.meshgrid(np.linspace(0, width, columns + 1), np.linspace(0, height, rows + 1))
        corners = np.arange(x.size).reshape(x.shape)
        top_left, top_right = corners[:-1, :-1], corners[:-1, 1:]
        bottom_left, bottom_right = corners[1:, :-1], corners[1:, 1:]
        upper = np.stack([top_left, top_right, bottom_left], axis=-1)
        lower = np.stack([bottom_right, bottom_left, top_right], axis=-1)
        triangles = np.stack([upper, lower], axis=2).reshape(-1, 3)
        return mesh_of(np.stack([x.ravel(), y.ravel()], axis=1), triangles, width, height)


def _cells(width: int, height: int, triangle_count: int) -> tuple[int, int]:
    """Columns and rows of nearly square cells, two triangles each."""
    cells = max(triangle_count / 2, 1)
    rows = min(max(round(sqrt(cells * height / width)), 1), height)
    columns = min(max(round(cells / rows), 1), width)
    return columns, rows
