"""PLY: vertices with colours, for MeshLab, Blender and most programs that read point clouds."""

from pathlib import Path
from typing import ClassVar

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format
from stages.exchange.solids.corners import HELD, Corners, corners_of, refuse_stacks


class Ply(Format):
    """One frame: binary, little-endian; faces carry the triangles' numbers.

    Source: Turk, The PLY Polygon File Format (1994).
    """

    styles: ClassVar[tuple[str, ...]] = HELD
    most_degree: ClassVar[int] = 1

    def __init__(self, film: Film) -> None:
        super().__init__(film)
        self._corners: Corners
        self._ids: np.ndarray

    @classmethod
    def check(cls, film: Film) -> None:
        """As every format, and one style only."""
        super().check(film)
        refuse_stacks(film)

    def add(self, figure: Figure) -> None:
        """Take the frame."""
        self._corners = corners_of(figure, self.film)
        self._ids = figure.mesh.triangle_ids

    def save(self, path: Path) -> None:
        """Write it."""
        count = len(self._ids)
        vertices = np.zeros(3 * count, dtype=[("place", "<f4", 3), ("color", "u1", 3)])
        vertices["place"] = self._corners.points.reshape(-1, 3)
        vertices["color"] = np.rint(self._corners.colors).reshape(-1, 3)
        faces = np.zeros(count, dtype=[("size", "u1"), ("corners", "<i4", 3), ("id", "<i4")])
        faces["size"], faces["id"] = 3, self._ids
        faces["corners"] = np.arange(3 * count).reshape(-1, 3)
        places = "".join(f"property float {name}\n" for name in "xyz")
        colors = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
        header = (
            f"ply\nformat binary_little_endian 1.0\nelement vertex {3 * count}\n{places}{colors}"
            f"element face {count}\nproperty list uchar int vertex_indices\nproperty int id\n"
            "end_header\n"
        )
        path.write_bytes(header.encode() + vertices.tobytes() + faces.tobytes())
