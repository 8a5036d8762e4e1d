"""Wavefront OBJ: text that every 3D program reads, with colours at the vertices."""

from pathlib import Path
from typing import ClassVar

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format
from stages.exchange.solids.corners import HELD, Corners, corners_of, refuse_stacks


class Obj(Format):
    """One frame: three vertices a triangle, `v x y z red green blue` with colours from 0 to 1.

    Deviation: Wavefront has no colours at vertices; Blender, MeshLab and others read them so.
    """

    styles: ClassVar[tuple[str, ...]] = HELD
    most_degree: ClassVar[int] = 1

    def __init__(self, film: Film) -> None:
        super().__init__(film)
        self._corners: Corners

    @classmethod
    def check(cls, film: Film) -> None:
        """As every format, and one style only."""
        super().check(film)
        refuse_stacks(film)

    def add(self, figure: Figure) -> None:
        """Take the frame."""
        self._corners = corners_of(figure, self.film)

    def save(self, path: Path) -> None:
        """Write it."""
        points = self._corners.points.reshape(-1, 3)
        rows = np.concatenate([points, self._corners.colors.reshape(-1, 3) / 255.0], axis=1)
        count = len(points)
        vertices = ("v %.9g %.9g %.9g %.6g %.6g %.6g\n" * count) % tuple(rows.ravel().tolist())
        faces = ("f %d %d %d\n" * (count // 3)) % tuple(range(1, count + 1))
        path.write_text(f"o {self.film.name}\n{vertices}{faces}", "utf-8", newline="\n")
