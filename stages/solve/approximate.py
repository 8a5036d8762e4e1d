"""A still picture, from a layout to an optimised mesh of a wanted number of triangles."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stages.mesh import Mesh
from stages.optimize import load_mesh, optimize, probe_of
from stages.optimize_options import OptimizeOptions
from stages.solve.convergence import Convergence
from stages.solve.hold import FREE, Hold
from stages.solve.mend import divide_torn
from stages.topology import Topology
from stages.topology.appraise import Appraiser
from stages.topology.area_limit import divide_large
from stages.topology.exact_count import with_exactly
from stages.topology.goal import Goal
from stages.topology.growth import Growth
from warp_kernels.color_model import CHANNELS
from warp_kernels.energy.workspace import DISPLACEMENT, Workspace

FEW = 64
"""Triangles of the layout where a threshold decides how many there will be."""
GROWING_SHARE = 0.6
"""Part of the refinement during which a threshold's triangles are split."""
REFINING_SHARE = 0.85
"""Part of the iterations during which the topology changes (the paper: 400 of 600)."""
ROUND = 8
"""Iterations between two looks at the topology, and at whether the energy has converged."""
CATCHING_UP = 8
"""More looks at the topology, if there are still too many triangles."""
SPARE = 0.8
"""Part of the largest area that triangles keep to before their vertices settle."""
LAST_TRUST = 0.1
"""Trust region of the last iteration beside the first one's: it shrinks so that vertices settle."""
LAST_DISPLACEMENT = 0.25
"""Distance of the variants in the last iterations [px]: a whole pixel blurs where an edge lies."""

MENDINGS = 3
"""Most times that triangles are divided which no one colour becomes."""
MENDING_TRUST = 0.5
"""Trust region beside the first one's where a few triangles were divided at the end."""


@dataclass(frozen=True, eq=False)
class Approximator:
    """Optimises meshes over the picture in a workspace."""

    workspace: Workspace
    """Holds the picture, and the mesh that was optimised last."""
    topology: Topology
    """Changes the mesh."""
    appraiser: Appraiser
    """Measures meshes in `workspace`."""
    options: OptimizeOptions
    """How vertices move."""
    iterations: int
    """Most iterations; fewer where the energy has converged."""
    hold: Hold = FREE
    """How much of the layout is kept."""

    @property
    def keeps_layout(self) -> bool:
        """Whether the layout is the look: nothing is moved, and no triangle comes or goes."""
        return self.iterations == 0 or self.hold.is_full

    def growth(self, goal: Goal) -> Growth:
        """How the number of triangles develops: a threshold decides by itself, from few on."""
        if goal.threshold is None:
            return self.topology.growth
        few = min(1.0, FEW / goal.count)
        return Growth(start=few, peak=1.0, grown=GROWING_SHARE, settled=GROWING_SHARE)

    def approximate(self, mesh: Mesh, goal: Goal) -> Mesh:
        """Refine and settle a mesh, which then lies in the workspace.

        Args:
            mesh: A layout.
            goal: What the result must be like.
        """
        if self.keeps_layout:
            load_mesh(self.workspace, mesh)
            return mesh
        layout = mesh
        mesh = self._counted(self._refine(mesh, goal), goal, SPARE)
        return self.within_limits(self._settle(mesh, layout), goal)

    def _springs(self, layout: Mesh, mesh: Mesh) -> np.ndarray | None:
        """What holds a mesh to its layout, or None."""
        if self.hold.share == 0.0:
            return None
        energy = float(self.appraiser.energies(mesh).sum())
        error = 2.0 * energy / (CHANNELS * mesh.width * mesh.height)
        return self.hold.springs(layout, mesh, error)

    def _counted(self, mesh: Mesh, goal: Goal, spare: float = 1.0) -> Mesh:
        """The mesh with the number of triangles that is wanted; a threshold's is a cap only."""
        if goal.threshold is not None and mesh.triangle_count <= goal.count:
            return mesh
        self.appraiser.limit(spare * goal.largest_area)
        return with_exactly(goal.count, mesh, self.appraiser)

    def _refine(self, mesh: Mesh, goal: Goal) -> Mesh:
        """Alternate optimisation and changes of topology until the wanted number is reached."""
        growth = self.growth(goal)
        rounds = max(1, int(self.iterations * REFINING_SHARE) // ROUND)
        convergence, layout = Convergence(), mesh
        for number in range(1, rounds + 1):
            load_mesh(self.workspace, mesh, self._springs(layout, mesh))
            probe = probe_of(mesh, DISPLACEMENT)
            mesh = optimize(self.workspace, mesh, ROUND, self.options, displacement=probe)
            progress = number / rounds
            # on the way the energy falls and rises with the number of triangles
            if progress > growth.settled and convergence.is_reached(self.workspace.last_energy()):
                break
            target = goal.tightened(growth.count(progress, goal.count), SPARE)
            mesh = self.topology.adapt(mesh, self.appraiser, target)
        for _ in range(CATCHING_UP):  # where the rounds were too few for the way down
            if mesh.triangle_count > goal.count + 1:
                target = goal.tightened(goal.count, SPARE)
                mesh = self.topology.adapt(mesh, self.appraiser, target)
        return mesh

    def _settle(self, mesh: Mesh, layout: Mesh) -> Mesh:
        """The last iterations: no change of topology, smaller and smaller steps.

        Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 6.6 (no Delaunay at
            the end), Sec. 3.2 (trust region that decreases over time).
        """
        left = self.iterations - int(self.iterations * REFINING_SHARE) // ROUND * ROUND
        load_mesh(self.workspace, mesh, self._springs(layout, mesh))
        convergence = Convergence()
        for begin in range(0, left, ROUND):
            mesh = optimize(
                self.workspace,
                mesh,
                min(ROUND, left - begin),
                self.options,
                trust_region=self.options.trust_region * LAST_TRUST ** (begin / left),
                displacement=LAST_DISPLACEMENT,
            )
            if convergence.is_reached(self.workspace.last_energy()):
                break
        return mesh

    def mended(self, mesh: Mesh, torn: Callable[[Mesh], np.ndarray], goal: Goal) -> Mesh:
        """Divide triangles that no one colour becomes, while that leaves fewer of them.

        Args:
            mesh: A mesh that has settled.
            torn: Tells the numbers of such triangles, [N].
            goal: What it must be like.
        """
        if self.keeps_layout or self.hold.share:  # as many others would go, of the layout's
            return mesh
        bad = torn(mesh)
        for _ in range(MENDINGS):
            if not len(bad):
                break
            divided = self._divided(mesh, bad, goal)
            left = torn(divided)
            if divided.triangle_count != mesh.triangle_count or len(left) >= len(bad):
                break
            mesh, bad = divided, left
        return mesh

    def _divided(self, mesh: Mesh, torn: np.ndarray, goal: Goal) -> Mesh:
        """Divide some triangles of a settled mesh; the rest hardly moves."""
        self.appraiser.limit(goal.largest_area)
        mesh = divide_torn(mesh, torn, self.appraiser)
        load_mesh(self.workspace, mesh)
        trust = self.options.trust_region * MENDING_TRUST
        mesh = optimize(
            self.workspace,
            mesh,
            ROUND,
            self.options,
            trust_region=trust,
            displacement=LAST_DISPLACEMENT,
        )
        return self.within_limits(mesh, goal)

    def within_limits(self, mesh: Mesh, goal: Goal) -> Mesh:
        """Divide what has grown beyond the largest area while vertices moved, and count.

        Args:
            mesh: The mesh in the workspace; so is the result.
            goal: What it must be like.
        """
        for _ in range(CATCHING_UP):
            divided = divide_large(mesh, goal.largest_area)
            if divided is mesh:
                break
            mesh = divided
            if mesh.triangle_count > goal.count + 1:
                mesh = self.topology.adapt(mesh, self.appraiser, goal)
            load_mesh(self.workspace, mesh)
        counted = self._counted(mesh, goal)
        if counted is not mesh:
            load_mesh(self.workspace, counted)
        return counted
