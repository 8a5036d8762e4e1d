"""Colours of a mesh that stays as it is: fitted, steadied, led to those of plain
ground, and kept within what is near by."""

import numpy as np

from stages.frame import Frame
from stages.hand.locks import NO_LOCKS, Locks
from stages.mesh import Mesh
from stages.optimize import place_mesh
from stages.snapshot import Snapshot
from stages.solve.color_limits import Limiter
from stages.solve.color_owners import color_owners
from stages.solve.grid import colors_through, rounded_energies, shades, tightened
from stages.solve.plain_colors import plainer
from stages.solve.steady_colors import steadied
from warp_kernels.energy.plain_colors import PlainColors
from warp_kernels.energy.workspace import Workspace


class Fitting:
    """Fits the colours of one model, in RGB and by all pixels alike.

    Args:
        workspace: Holds the picture in RGB; fixes the model.
    """

    def __init__(self, workspace: Workspace) -> None:
        self.workspace = workspace
        """Where it is done."""
        self._limiter = Limiter(workspace)
        self._plain = PlainColors(workspace) if workspace.model.degree == 0 else None

    def snapshot(
        self,
        frame: Frame,
        mesh: Mesh,
        earlier: Snapshot | None = None,
        locks: Locks = NO_LOCKS,
        calm: np.ndarray | None = None,
    ) -> Snapshot:
        """Fit colours to a mesh.

        Args:
            frame: The frame whose picture the workspace holds.
            mesh: The triangles.
            earlier: The frame before, to whose colours they keep if they may; None for the best.
            locks: What a person holds.
            calm: How far they keep to these at each triangle [0..1], [T]; None for all the way.
        """
        place_mesh(self.workspace, mesh)
        best, left, counts = self.workspace.fit()
        coefficients, energies = best, left
        if earlier is not None:
            coefficients, energies = steadied(earlier, mesh, counts, coefficients, energies, calm)
        if self._plain is not None:
            coefficients, energies = plainer(self._plain, counts, best, left, coefficients)
        coefficients, energies, limits = self._limiter.limit(mesh, coefficients, energies)
        model = self.workspace.model
        values = shades(mesh, model, coefficients)
        coefficients = colors_through(mesh, model, values)
        if limits is not None:
            limits = tightened(model, values, limits)
        owners = color_owners(mesh, counts)
        return Snapshot(
            frame_index=frame.index,
            pts=frame.pts,
            time_base=frame.time_base,
            mesh=mesh,
            model=model,
            coefficients=coefficients[owners],
            energies=rounded_energies(energies),
            counts=counts,
            limits=None if limits is None else limits[owners],
            locks=locks.within(mesh),
        )

    def torn(self, frame: Frame, mesh: Mesh) -> np.ndarray:
        """The triangles of a mesh that no one colour becomes, [N].

        Args:
            frame: As in `snapshot`.
            mesh: The triangles.
        """
        self.snapshot(frame, mesh)
        return self._limiter.torn
