"""Measure what triangles cost and what changes of topology would gain."""

import numpy as np

from stages.hand.locks import NO_LOCKS, Held, Locks
from stages.mesh import Mesh
from stages.optimize import place_mesh
from stages.snapshot import colors_at_centres
from warp_kernels.energy.topology_gains import IMPOSSIBLE
from warp_kernels.energy.topology_survey import Survey
from warp_kernels.energy.workspace import Workspace

EMPHASIS = 0.5
"""Power of the weights with which thresholds grow."""
LEAST_EMPHASIS = 0.1
"""Emphasis of triangles that cover hardly a pixel, and least of all."""


class Appraiser:
    """Energies and gains of one mesh at a time, over the picture in a workspace.

    Args:
        workspace: Holds the picture.
        least_height: Changes that would leave a triangle thinner than this are impossible [px].
    """

    def __init__(self, workspace: Workspace, least_height: float) -> None:
        self._workspace = workspace
        self._least_height = least_height
        self._survey = Survey(workspace)
        self.limit(np.inf)
        self._locks = NO_LOCKS
        self.held: Held | None = None
        """What a person holds fast of the measured mesh; None for nothing."""
        self._measured: Mesh | None = None
        self._energies = np.zeros(0)
        self.colors = np.zeros((0, 3))
        """Colour at the centre of each triangle of the measured mesh [code values], [T, 3]."""
        self.counts = np.zeros(0, dtype=np.int64)
        """Pixels of each triangle of the measured mesh, or the sum of their weights, [T]."""

    def energies(self, mesh: Mesh) -> np.ndarray:
        """Take a mesh and measure it.

        Returns:
            E(T) [code value^2 px], [T].
        """
        if mesh is self._measured:
            return self._energies
        place_mesh(self._workspace, mesh)
        coefficients, self._energies, self.counts = self._workspace.fit()
        self.colors = colors_at_centres(mesh, self._workspace.model, coefficients)
        self._survey.load_topology(mesh.twins, mesh.triangles.reshape(-1))
        self._measured = mesh
        self.held = None if self._locks.is_empty else self._locks.held(mesh)
        return self._energies

    def emphasis(self, half_edges: np.ndarray) -> np.ndarray | float:
        """How much more errors count beside edges of the measured mesh than on the whole.

        Energies grow with the weights of pixels; what only flickers does so as well.

        Returns:
            1 in the mean over the picture, [N]; 1 where all pixels count alike.
        """
        mesh = self._measured
        if not self._workspace.weighted or mesh is None:
            return 1.0
        mean = self.counts.sum() / mesh.areas.sum()
        weights = np.maximum(self.counts / (mean * mesh.areas), LEAST_EMPHASIS)
        beside = np.where(mesh.twins[half_edges] >= 0, mesh.twins[half_edges], half_edges)
        heaviest: np.ndarray = np.maximum(weights[half_edges // 3], weights[beside // 3])
        return heaviest**EMPHASIS

    def hold(self, locks: Locks) -> None:
        """Bar changes of what a person holds fast.

        Args:
            locks: From now on, in place of others.
        """
        self._locks = locks
        self._measured = None

    def loose(self, mesh: Mesh, triangles: np.ndarray) -> np.ndarray:
        """Those of some triangles that have no corner which is held fast.

        Args:
            mesh: A mesh, measured or not.
            triangles: Their numbers, shape [N].
        """
        if self._locks.is_empty:
            return triangles
        held = self._locks.held(mesh).kept
        return triangles[~held[mesh.triangles[triangles]].any(axis=1)]

    def forget(self) -> None:
        """The picture has changed: what was measured is void."""
        self._measured = None

    def limit(self, largest_area: float, *, is_height_free: bool = False) -> None:
        """Bar changes that would make a triangle larger than this [px^2], or too thin.

        Args:
            largest_area: Largest area [px^2].
            is_height_free: Whether triangles may become as thin as can be.
        """
        self._survey.limit(0.0 if is_height_free else self._least_height, largest_area)

    def flip_gains(self, half_edges: np.ndarray) -> np.ndarray:
        """Energy that flipping each edge of the measured mesh saves [code value^2 px], [N]."""
        gains = self._survey.flip_gains(half_edges)
        if self.held is None:
            return gains
        return np.where(self.held.edges[half_edges], -IMPOSSIBLE, gains)

    def collapse_costs(self, half_edges: np.ndarray) -> np.ndarray:
        """Energy that moving each origin into its destination adds [code value^2 px], [N]."""
        costs = self._survey.collapse_costs(half_edges)
        if self.held is None or self._measured is None:
            return costs
        origins = self._measured.triangles.reshape(-1)[half_edges]
        return np.where(self.held.kept[origins], IMPOSSIBLE, costs)

    def split_gains(self, half_edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Energy that the best split of each edge saves [code value^2 px], [N], and its place."""
        gains, points = self._survey.split_gains(half_edges)
        if self.held is None:
            return gains, points
        return np.where(self.held.undivided[half_edges], -IMPOSSIBLE, gains), points
