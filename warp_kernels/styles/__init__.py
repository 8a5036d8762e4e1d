"""Looks of the finished triangles: `STYLES` names them for the command line.

A style is a frozen dataclass of parameters with a `shader` (a wp.func), the `parameters` that it
hands to it, and the degree of the colour that it draws; a new one is a file and a line here.
"""

from typing import Any, ClassVar, Protocol

from warp_kernels.styles.edges import Edges
from warp_kernels.styles.flat import Flat
from warp_kernels.styles.gradient import Gradient


class Style(Protocol):
    """What every member of `STYLES` can do."""

    degree: ClassVar[int]
    """Least degree of the colour polynomial that the shader needs."""
    shader: ClassVar[Any]
    """A wp.func `(Scene, StyleParameters, Sample) -> vec4f`: colour [code values], opacity."""

    @property
    def line_width(self) -> float:
        """Width of the edges that must be drawn beforehand [px of the picture], 0 for none."""
        ...

    def parameters(self) -> tuple[float, ...]:
        """At most eight numbers for the shader."""
        ...


STYLES: dict[str, type[Style]] = {
    "edges": Edges,
    "flat": Flat,
    "gradient": Gradient,
}
