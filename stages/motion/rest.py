"""What of a followed mesh has arrived: there nothing moves any more, and nothing is looked at."""

from dataclasses import dataclass

import numpy as np

from stages.mesh import Mesh
from stages.motion.correspondence import kept_rows

LEAST_CHANGE = 0.01
"""A vertex has arrived once the energy of the triangles around it changes by less than this part in
a round."""
FAINT = 1.0
"""Part of a triangle's mean energy that is added to each: beside almost nothing every change is
large."""


@dataclass(frozen=True, eq=False)
class Rest:
    """The vertices that have arrived."""

    vertex_ids: np.ndarray
    """Their persistent numbers, shape [N]."""

    @classmethod
    def after(
        cls,
        before: Mesh,
        had: np.ndarray,
        mesh: Mesh,
        energies: np.ndarray,
        least: float = LEAST_CHANGE,
    ) -> "Rest":
        """Compare the triangles of a mesh with what they were a round before.

        Args:
            before: The mesh at the beginning of the round.
            had: E(T) there [code value^2 px], [T].
            mesh: What has become of it.
            energies: E(T) of that, over the same picture.
            least: A vertex has arrived once the energy around it changes by less than this part.
        """
        rows = _untouched(before, mesh)
        faint = FAINT * energies.mean()
        change = np.where(rows >= 0, had[rows] - energies, np.inf)
        corners = mesh.triangles.reshape(-1)
        changes = np.bincount(corners, np.repeat(change, 3), mesh.vertex_count)
        around = np.bincount(corners, np.repeat(energies + faint, 3), mesh.vertex_count)
        return cls(mesh.vertex_ids[np.abs(changes) < least * around])

    def but_for(self, before: Mesh, mesh: Mesh) -> "Rest":
        """Without the vertices of triangles that an edit has made.

        Args:
            before: The mesh before the edits.
            mesh: The mesh after them.
        """
        if mesh is before:
            return self
        new = mesh.triangles[_untouched(before, mesh) < 0]
        return Rest(np.setdiff1d(self.vertex_ids, mesh.vertex_ids[new]))

    def free(self, mesh: Mesh) -> np.ndarray:
        """The vertices that have not arrived, shape [V] bool.

        Args:
            mesh: The mesh after any edits.
        """
        return ~np.isin(mesh.vertex_ids, self.vertex_ids)

    def unsettled(self, mesh: Mesh) -> np.ndarray:
        """Triangles with such a vertex, shape [T] bool.

        Args:
            mesh: The mesh after any edits.
        """
        found: np.ndarray = self.free(mesh)[mesh.triangles].any(axis=1)
        return found


def _untouched(before: Mesh, mesh: Mesh) -> np.ndarray:
    """Rows of triangles in the mesh before edits; -1 where an edit has made one, shape [T]."""
    rows = kept_rows(before.triangle_ids, mesh.triangle_ids)
    had = before.vertex_ids.take(before.triangles.take(rows, axis=0))
    has = mesh.vertex_ids.take(mesh.triangles)
    return np.where((rows >= 0) & (had == has).all(axis=1), rows, -1)
