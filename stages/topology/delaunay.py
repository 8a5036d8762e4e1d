"""The paper's way: split the worst triangles, collapse slivers, keep the Delaunay property."""

from dataclasses import dataclass

from stages.edits import legalise
from stages.mesh import Mesh
from stages.motion.correspondence import kept_triangles
from stages.topology.appraise import Appraiser
from stages.topology.area_limit import divide_large
from stages.topology.collapse_slivers import collapse_slivers
from stages.topology.goal import SLIVER_HEIGHT, Goal
from stages.topology.growth import Growth
from stages.topology.refine import split_worst

HALF = Growth(start=0.5, peak=1.0, grown=0.6, settled=0.6)
"""Refinement places every second triangle."""
STEADY = Growth(start=1.0, peak=1.0, grown=0.0, settled=0.0)
"""No triangle goes that is not a sliver, so there must not be too many."""


@dataclass(frozen=True)
class Delaunay:
    """Centroids of the worst triangles, and edges flipped until the mesh is Delaunay.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.4.
    """

    growth: Growth = HALF
    """How the number of triangles develops in a first frame."""
    renewal: Growth = STEADY
    """How it develops where a followed picture boils."""

    def adapt(self, mesh: Mesh, appraiser: Appraiser, goal: Goal) -> Mesh:
        """Collapse, split and flip.

        Args:
            mesh: A valid mesh.
            appraiser: Measures it.
            goal: What to reach. Followed calmly, only the surroundings of what changed are made
                Delaunay again: restoring the whole mesh would make triangles pop in every frame.
        """
        before = mesh
        mesh = collapse_slivers(mesh, SLIVER_HEIGHT)
        energies = appraiser.energies(mesh)
        mesh = split_worst(mesh, energies, count=goal.count, threshold=goal.threshold)
        mesh = legalise(mesh, kept_triangles(before, mesh) < 0 if goal.calm else None)
        return divide_large(mesh, goal.largest_area)
