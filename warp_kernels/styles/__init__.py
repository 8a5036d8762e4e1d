"""Looks of the finished triangles: `STYLES` names them for the command line.

A style is a file with a frozen dataclass of parameters, see `Style`, and a wp.func that draws, in a
file of `shaders`; a new one is these two and a line here, or a package of its own.
"""

from warp_kernels.registry import Registry
from warp_kernels.styles.style import Style

__all__ = ["STYLES", "Style"]

STYLES: Registry[Style] = Registry(
    "styles",
    {
        "circles": "warp_kernels.styles.circles:Circles",
        "crosshatching": "warp_kernels.styles.crosshatching:Crosshatching",
        "edges": "warp_kernels.styles.edges:Edges",
        "flat": "warp_kernels.styles.flat:Flat",
        "gradient": "warp_kernels.styles.gradient:Gradient",
        "hatching": "warp_kernels.styles.hatching:Hatching",
        "incircles": "warp_kernels.styles.incircles:Incircles",
        "lenses": "warp_kernels.styles.lenses:Lenses",
        "paper": "warp_kernels.styles.paper:Paper",
        "shrink": "warp_kernels.styles.shrink:Shrink",
        "source": "warp_kernels.styles.source:Source",
        "texture": "warp_kernels.styles.texture:Texture",
    },
    method="shader",
)
