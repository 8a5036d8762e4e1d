"""The layout of a sunflower: points on a spiral, each turned by the golden angle."""

from dataclasses import dataclass, field
from math import pi, sqrt
from typing import TYPE_CHECKING

from stages.layouts.radial import check_shares

if TYPE_CHECKING:
    import numpy as np

    from stages.mesh import Mesh

GOLDEN_ANGLE = pi * (3.0 - sqrt(5.0))
"""Turn from one point to the next: of all it leaves the fewest gaps."""


@dataclass(frozen=True)
class Phyllotaxis:
    """Seeds of a sunflower: even, without rows, and with spirals that lead to the centre.

    Source: Vogel, A better way to construct the sunflower head (1979).
    """

    center_x: float = field(default=0.5)
    """Centre across, as a part of the width [0..1]."""
    center_y: float = field(default=0.5)
    """Centre down, as a part of the height [0..1]."""

    def __post_init__(self) -> None:
        check_shares(self, "center_x", "center_y")

    def build(
        self, pixels: "np.ndarray", triangle_count: int, rng: "np.random.Generator"
    ) -> "Mesh":
        """Lay the seeds over a picture.

        Args:
            pixels: The picture, shape [H, W, 3] uint8; only its size matters.
            triangle_count: Wanted number of triangles.
            rng: Not used.
        """
        import numpy as np

        from stages.layouts.even_points import fitted_mesh

        height, width = pixels.shape[:2]
        size = np.array([width, height])
        center = np.array([self.center_x, self.center_y]) * size
        reach = float(np.linalg.norm(np.maximum(center, size - center)))

        def seeds(spacing: float) -> np.ndarray:
            """Points from the centre out, as dense as equal triangles of that side."""
            growth = spacing * sqrt(sqrt(3.0) / (2.0 * pi))
            numbers = np.arange(int((reach / growth) ** 2) + 1)
            radii, angles = growth * np.sqrt(numbers + 0.5), numbers * GOLDEN_ANGLE
            around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
            found: np.ndarray = center + radii[:, None] * around
            return found

        return fitted_mesh(pixels, triangle_count, seeds)
