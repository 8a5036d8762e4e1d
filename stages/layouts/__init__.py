"""Initial triangulations of a picture: `LAYOUTS` names them for the command line.

A layout is a frozen dataclass of parameters with one method
`build(pixels [H, W, 3] uint8, triangle_count, rng) -> Mesh`; a new one is a file and a line here.
"""

from typing import Protocol

import numpy as np

from stages.layouts.grid import Grid
from stages.layouts.importance import Importance
from stages.mesh import Mesh


class Layout(Protocol):
    """What every member of `LAYOUTS` can do."""

    def build(self, pixels: np.ndarray, triangle_count: int, rng: np.random.Generator) -> Mesh:
        """Triangulate a picture [H, W, 3] uint8 with about `triangle_count` triangles."""
        ...


LAYOUTS: dict[str, type[Layout]] = {
    "grid": Grid,
    "importance": Importance,
}
