"""One later frame: vertices on springs take steps, and between them the topology is looked at."""

from dataclasses import dataclass, replace

import numpy as np

from stages.mesh import Mesh
from stages.motion.advect import Carried
from stages.motion.rest import Rest
from stages.motion.springs import springs_of
from stages.optimize import load_mesh, optimize, probe_of
from stages.optimize_options import OptimizeOptions
from stages.solve.bench import Bench
from stages.solve.convergence import Convergence
from stages.topology.goal import Goal

DISPLACEMENT = 0.75
"""Distance of the variants in later frames, where triangles are large [px]: a wider one finds
steadier places, and a narrower one those that fit the picture better."""
DEAD_BAND = 0.1
"""Steps of later frames below this are not taken [px]: noise must not move what stands still."""


@dataclass(frozen=True, eq=False)
class Following:
    """What holds for all rounds of a frame."""

    bench: Bench
    """Holds the picture."""
    options: OptimizeOptions
    """How vertices move."""
    seed: Carried
    """Where the motion took the vertices."""
    energies: np.ndarray
    """E(T) of the seed in this picture [code value^2 px], [T]."""
    spring: float
    """Strength of a vertex's spring where the motion is certain [code value^2]."""
    hold: float
    """Strength of all springs beside that, for a layout that is kept [code value^2]."""
    weights: np.ndarray | None
    """The picture's, [H, W] uint8, or None."""
    iterations: int
    """Steps of a round; 0 where nothing may move."""

    def moved(self, mesh: Mesh, free: np.ndarray | None = None) -> Mesh:
        """Optimise, with every vertex on a spring to where the motion took it.

        Args:
            mesh: What has become of the seed.
            free: Vertices that move, [V] bool; None for all.
        """
        springs = springs_of(mesh, self.seed, self.spring, self.weights, self.hold)
        load_mesh(self.bench.workspace, mesh, springs, free)
        return optimize(
            self.bench.workspace,
            mesh,
            self.iterations,
            self.options,
            dead_band=DEAD_BAND,
            displacement=probe_of(mesh, DISPLACEMENT),
        )

    def adapted(self, mesh: Mesh, goal: Goal) -> Mesh:
        """One look at the topology."""
        return self.bench.approximator.topology.adapt(mesh, self.bench.appraiser, goal)

    def settled(self, mesh: Mesh, goal: Goal, rounds: int, convergence: Convergence) -> Mesh:
        """Look and move until a round saves little; what has arrived is left alone.

        The first look goes over all of the mesh: what it finds where nothing moves any more would
        else be left for good, and the error would creep up from frame to frame.

        Args:
            mesh: What has become of the seed after the first steps.
            goal: What the mesh must be like.
            rounds: Most looks at the topology.
            convergence: Says when to stop.
        """
        before, had = self.seed.mesh, self.energies
        for number in range(rounds):
            energies = self.bench.appraiser.energies(mesh)
            if self.iterations and convergence.is_reached(float(energies.sum())):
                break
            rest = self._rest(before, had, mesh, energies, goal)
            before, had = mesh, energies
            mesh = self.adapted(mesh, replace(goal, rest=rest if number else None))
            mesh = self.moved(mesh, None if rest is None else rest.but_for(before, mesh).free(mesh))
        return mesh

    def _rest(
        self, before: Mesh, had: np.ndarray, mesh: Mesh, energies: np.ndarray, goal: Goal
    ) -> Rest | None:
        """What has arrived; nothing where the picture boils, or where nothing could move."""
        if goal.unrest is not None or not self.iterations:
            return None
        return Rest.after(before, had, mesh, energies)
