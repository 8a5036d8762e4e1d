"""Ours and the paper's method as settings of the same program."""

from dataclasses import dataclass, field, replace

from stages.optimize_options import OptimizeOptions
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions

PAPER_ITERATIONS = 600
"""400 with refinement and 200 without, Sec. 6.4."""
PAPER_STEPS = OptimizeOptions(regularity=1e-3, trust_region=0.2)
"""lambda of Sec. 6.2 and the trust region of Sec. 3.2 [px]."""


@dataclass(frozen=True)
class Method:
    """How a picture becomes triangles."""

    options: TriangulateOptions = field(default_factory=TriangulateOptions)
    """All but the number of triangles."""
    layout: str = "importance"
    """Member of `LAYOUTS` that makes the first mesh."""

    def with_triangles(self, count: int, error: float | None = None) -> TriangulateOptions:
        """The options with a number of triangles, and a threshold [code values] if wanted."""
        return replace(self.options, refine=RefineOptions(triangles=count, error=error))

    def with_options(self, **changes: object) -> "Method":
        """The method with other options of `TriangulateOptions`."""
        return replace(self, options=replace(self.options, **changes))


def ours(color: str = "constant") -> Method:
    """What the command line does by default."""
    return Method(TriangulateOptions(color=color))


def papers(color: str = "constant") -> Method:
    """The paper's Delaunay topology with its settings.

    It starts from the same layout as ours, one of the paper's two (Sec. 3.3).
    """
    return Method(
        TriangulateOptions(
            color=color,
            topology="delaunay",
            iterations=PAPER_ITERATIONS,
            optimize=PAPER_STEPS,
        )
    )


BOTH = (("the paper's", papers), ("ours", ours))
"""Names and makers of the methods that most experiments set side by side."""
