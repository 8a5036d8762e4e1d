"""The importance layout: Delaunay triangles over vertices drawn where the picture matters."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

    from stages.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Importance:
    """Vertices drawn from a map of importance by the inverse of its distribution.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.3.
    Deviation: vertices keep a distance, which the dense places give up step by step, because
        near duplicates make slivers; the border has vertices of its own, drawn along it.
    """

    importance_map: "np.ndarray | None" = None
    """Grey picture of importance, shape [h, w], any size; None takes the picture's saliency."""
    even_share: float = 0.2
    """Share of the vertices that is spread evenly, so that calm areas get some [0..1]."""
    border_density: float = 0.7
    """Density of vertices along the border relative to an even spread's [1]."""

    def build(
        self, pixels: "np.ndarray", triangle_count: int, rng: "np.random.Generator"
    ) -> "Mesh":
        """Draw the vertices and triangulate them.

        Args:
            pixels: The picture, shape [H, W, 3] uint8.
            triangle_count: Wanted number of triangles; met exactly unless there is more than
                one to a pixel.
            rng: Source of the draws.

        Raises:
            OptionError: If the importance map is negative, not finite or zero everywhere.
        """
        from stages.layouts.drawn_vertices import drawn_mesh

        shares = self.even_share, self.border_density
        return drawn_mesh(pixels, triangle_count, rng, self.importance_map, *shares)
