"""How firmly a mesh keeps to its layout: springs, and fewer changes of its topology."""

from dataclasses import dataclass, replace

import numpy as np

from stages.mesh import Mesh
from stages.topology import Topology
from stages.topology.energy import Energy
from stages.topology.growth import Growth

FIRM = 20.0
"""Strength of the spring of a half-kept layout, as a multiple of the mean squared error of the
mesh: what pulls at a vertex grows with that and with the length of its edges, so layouts of any
size are held alike."""
FIRMEST = 1e6
"""Strength beyond which nothing moves, in the same measure."""
STEADY = Growth(start=1.0, peak=1.0, grown=0.0, settled=0.0)
"""No triangle more than there will be: those that go again would be the layout's."""


@dataclass(frozen=True)
class Hold:
    """How much of a layout is kept."""

    share: float
    """0 for nothing, 1 for all of it."""

    @property
    def is_full(self) -> bool:
        """Whether the layout stays as it is."""
        return self.share == 1.0

    def strength(self, squared_error: float) -> float:
        """Of the springs [code value^2].

        Args:
            squared_error: Mean squared error of the mesh [code value^2].
        """
        if self.share == 0.0:
            return 0.0
        return squared_error * min(FIRM * self.share / max(1.0 - self.share, 1e-9), FIRMEST)

    def springs(self, layout: Mesh, mesh: Mesh, squared_error: float) -> np.ndarray | None:
        """Where vertices of a layout are held; those that came since are free.

        Args:
            layout: The layout.
            mesh: What has become of it.
            squared_error: Its mean squared error [code value^2].

        Returns:
            Places [px], strengths [code value^2] and no friction, [V, 4]; None if nothing is
            held.
        """
        if self.share == 0.0:
            return None
        springs = np.zeros((mesh.vertex_count, 4))
        springs[:, :2] = mesh.vertices
        known = mesh.vertex_ids < layout.next_vertex_id
        springs[known, :2] = layout.vertices[
            np.searchsorted(layout.vertex_ids, mesh.vertex_ids[known])
        ]
        springs[known, 2] = self.strength(squared_error)
        return springs

    def calmed(self, topology: Topology) -> Topology:
        """A topology that changes less."""
        if self.share == 0.0 or not isinstance(topology, Energy):
            return topology
        free = (1.0 - self.share) ** 4
        return replace(
            topology,
            growth=STEADY,
            flip=max(topology.flip, 0.5 * self.share),
            calm_flip=max(topology.calm_flip, 0.5 * self.share),
            relocated=free * topology.relocated,
            calm_relocated=free * topology.calm_relocated,
            beside_boiling=free * topology.beside_boiling,
        )


FREE = Hold(0.0)
"""Nothing is kept."""
