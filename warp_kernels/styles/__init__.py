"""Looks of the finished triangles: `STYLES` names them for the command line.

A style is a file with a frozen dataclass of parameters, see `Style`, and a wp.func that draws; a
new one is a file and a line here.
"""

from warp_kernels.styles.circles import Circles
from warp_kernels.styles.crosshatching import Crosshatching
from warp_kernels.styles.edges import Edges
from warp_kernels.styles.flat import Flat
from warp_kernels.styles.gradient import Gradient
from warp_kernels.styles.hatching import Hatching
from warp_kernels.styles.incircles import Incircles
from warp_kernels.styles.lenses import Lenses
from warp_kernels.styles.paper import Paper
from warp_kernels.styles.shrink import Shrink
from warp_kernels.styles.source import Source
from warp_kernels.styles.style import Style
from warp_kernels.styles.texture import Texture

__all__ = ["STYLES", "Edges", "Flat", "Gradient", "Style"]

STYLES: dict[str, type[Style]] = {
    "circles": Circles,
    "crosshatching": Crosshatching,
    "edges": Edges,
    "flat": Flat,
    "gradient": Gradient,
    "hatching": Hatching,
    "incircles": Incircles,
    "lenses": Lenses,
    "paper": Paper,
    "shrink": Shrink,
    "source": Source,
    "texture": Texture,
}
