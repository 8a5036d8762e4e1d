"""The layout of somebody's own points."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from warp_kernels.errors import OptionError

if TYPE_CHECKING:
    import numpy as np

    from stages.mesh import Mesh

AT_BORDER = 0.5
"""Points nearer to the border than this lie on it [px]: a thinner triangle shows nothing."""


@dataclass(frozen=True, eq=False)
class Points:
    """Points of a file, with the corners of the picture; Delaunay triangles over them."""

    places: "np.ndarray | None" = field(default=None, metadata={"reads": "points"})
    """Places across and down, [N, 2]: pixels, or parts of width and height if none is above 1."""

    def build(
        self, pixels: "np.ndarray", triangle_count: int, rng: "np.random.Generator"
    ) -> "Mesh":
        """Triangulate the points.

        Args:
            pixels: The picture, shape [H, W, 3] uint8; only its size matters.
            triangle_count: Not used: the number follows from the points.
            rng: Not used.

        Raises:
            OptionError: If there are no points, or some lie beside the picture.
        """
        import numpy as np

        from stages.layouts.even_points import delaunay_mesh

        if self.places is None:
            raise OptionError("--layout points: needs a file; write points:FILE.csv")
        height, width = pixels.shape[:2]
        size = np.array([width, height], dtype=np.float64)
        found = np.asarray(self.places, dtype=np.float64)
        found = found * size if found.max() <= 1.0 else found
        beside = ((found < -AT_BORDER) | (found > size + AT_BORDER)).any(axis=1)
        if beside.any():
            x, y = found[np.flatnonzero(beside)[0]]
            raise OptionError(
                f"--layout points: {int(beside.sum())} of {len(found)} points lie beside the "
                f"picture of {width}x{height}, such as {x:g} {y:g}; give pixels, or parts of it "
                "between 0 and 1"
            )
        found = np.where(found < AT_BORDER, 0.0, found)
        found = np.where(found > size - AT_BORDER, size, found)
        corners = np.array([[0, 0], [width, 0], [0, height], [width, height]], dtype=np.float64)
        return delaunay_mesh(np.concatenate([corners, found]), width, height)
