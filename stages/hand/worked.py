"""A mesh that a person works on, and what of it is held fast."""

from dataclasses import dataclass, replace

import numpy as np

from stages.hand.locks import NO_LOCKS, Locks
from stages.masks.area import Stroke
from stages.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Worked:
    """A mesh between two edits."""

    mesh: Mesh
    """A valid mesh."""
    locks: Locks = NO_LOCKS
    """What is held fast in it."""
    focus: tuple[Stroke, ...] = ()
    """Where a person painted that errors count more, since the mesh was solved."""

    def became(self, mesh: Mesh, locks: Locks | None = None) -> "Worked":
        """What an edit made of it; locks end with what they lay on.

        Args:
            mesh: The mesh after the edit.
            locks: What is held now; as before if left out.
        """
        return replace(self, mesh=mesh, locks=(self.locks if locks is None else locks).within(mesh))

    def fresh_vertices(self, mesh: Mesh) -> np.ndarray:
        """Ids of the vertices that an edit added.

        Args:
            mesh: The mesh after the edit.
        """
        return mesh.vertex_ids[mesh.vertex_ids >= self.mesh.next_vertex_id]
