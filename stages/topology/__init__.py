"""How the edges of a mesh are kept: `TOPOLOGIES` names the ways for the command line.

A topology is a frozen dataclass of parameters, two of them its `growth` and its `renewal`, with one
method `adapt(mesh, appraiser, goal) -> Mesh`; a new one is a file and a line here.
"""

from typing import TYPE_CHECKING, Protocol

from warp_kernels.registry import Registry

if TYPE_CHECKING:
    from stages.mesh import Mesh
    from stages.topology.appraise import Appraiser
    from stages.topology.goal import Goal
    from stages.topology.growth import Growth


class Topology(Protocol):
    """What every member of `TOPOLOGIES` can do."""

    @property
    def growth(self) -> "Growth":
        """How the number of triangles develops in a first frame."""
        ...

    @property
    def renewal(self) -> "Growth":
        """How it develops in later frames, where the picture boils."""
        ...

    def adapt(self, mesh: "Mesh", appraiser: "Appraiser", goal: "Goal") -> "Mesh":
        """Bring a mesh closer to a goal by edits.

        Vertices stay where they are, but for those that are pressed onto the border close by.
        """
        ...


TOPOLOGIES: Registry[Topology] = Registry(
    "topologies",
    {
        "delaunay": "stages.topology.delaunay:Delaunay",
        "energy": "stages.topology.energy:Energy",
    },
)
