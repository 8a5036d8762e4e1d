"""Remove vertices with a brush."""

from dataclasses import dataclass

import numpy as np

from stages.hand.brush import check_brush
from stages.hand.find import Point, check_inside
from stages.hand.vanish import without_vertices
from stages.hand.worked import Worked
from warp_kernels.errors import EditError


@dataclass(frozen=True)
class Remove:
    """Vertices under a round brush go, and none come back there.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5.
    """

    frame: int
    """Number of the frame."""
    at: Point
    """Centre of the brush [px]."""
    radius: float
    """Its radius [px]."""
    count: int = 10
    """How many vertices; fewer where there are fewer."""
    spread: str = "uniform"
    """uniform or normal: most in the middle, the radius is then two standard deviations."""
    seed: int = 0
    """Seed of which ones go."""

    def apply(self, worked: Worked) -> Worked:
        """Remove the vertices.

        Raises:
            EditError: If the brush is outside of the picture, or no vertex under it can go.
        """
        mesh = worked.mesh
        centre = check_inside(mesh, self.at)
        check_brush(self.radius, self.count, self.spread, self.seed)
        away = np.linalg.norm(mesh.vertices - centre, axis=1)
        corners = mesh.on_left_right & mesh.on_top_bottom
        under = np.flatnonzero((away <= self.radius) & ~corners)
        draws = np.random.default_rng(self.seed).random(len(under))
        if self.spread == "normal":  # the middle first, as often as a normal brush touches it
            draws = draws ** np.exp(2.0 * (away[under] / self.radius) ** 2)
            chosen = under[np.argsort(-draws, kind="stable")[: self.count]]
        else:
            chosen = under[np.argsort(draws, kind="stable")[: self.count]]
        found, gone = without_vertices(worked, chosen)
        if not gone:
            raise EditError(
                f"no vertex within {self.radius:g} px of ({self.at[0]:g}, {self.at[1]:g}) can go; "
                "use a larger brush"
            )
        return found
