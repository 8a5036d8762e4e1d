"""Initial triangulations of a picture: `LAYOUTS` names them for the command line.

A layout is a frozen dataclass of parameters with one method
`build(pixels [H, W, 3] uint8, triangle_count, rng) -> Mesh`, which imports what it needs: the help
reads the parameters of all. A new one is a file and a line here, or a package of its own.
"""

from typing import TYPE_CHECKING, Protocol

from warp_kernels.registry import Registry

if TYPE_CHECKING:
    import numpy as np

    from stages.mesh import Mesh


class Layout(Protocol):
    """What every member of `LAYOUTS` can do."""

    def build(
        self, pixels: "np.ndarray", triangle_count: int, rng: "np.random.Generator"
    ) -> "Mesh":
        """Triangulate a picture [H, W, 3] uint8 with about `triangle_count` triangles."""
        ...


LAYOUTS: Registry[Layout] = Registry(
    "layouts",
    {
        "grid": "stages.layouts.grid:Grid",
        "importance": "stages.layouts.importance:Importance",
        "poisson": "stages.layouts.poisson:Poisson",
        "edges": "stages.layouts.outlines:Outlines",
        "radial": "stages.layouts.radial:Radial",
        "hex": "stages.layouts.hexagons:Hexagons",
        "phyllotaxis": "stages.layouts.phyllotaxis:Phyllotaxis",
        "points": "stages.layouts.points:Points",
    },
    method="build",
)
