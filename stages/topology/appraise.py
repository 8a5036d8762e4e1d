"""Measure what triangles cost and what changes of topology would gain."""

import numpy as np

from stages.mesh import Mesh
from stages.optimize import place_mesh
from stages.snapshot import colors_at_centres
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
        return self._survey.flip_gains(half_edges)

    def collapse_costs(self, half_edges: np.ndarray) -> np.ndarray:
        """Energy that moving each origin into its destination adds [code value^2 px], [N]."""
        return self._survey.collapse_costs(half_edges)

    def split_gains(self, half_edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Energy that the best split of each edge saves [code value^2 px], [N], and its place."""
        return self._survey.split_gains(half_edges)
