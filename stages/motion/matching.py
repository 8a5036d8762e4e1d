"""Two meshes of one picture that were found apart: which of their vertices are the same."""

from dataclasses import dataclass, replace

import numpy as np

from stages.mesh import Mesh

REACH = 0.5
"""How far two vertices may lie apart to be the same, as a part of the mean distance of vertices."""


@dataclass(frozen=True, eq=False)
class Matching:
    """Numbers of vertices in a solution, and in another one of the same film."""

    known: np.ndarray
    """Ids of one solution, ascending, [N] int64."""
    meant: np.ndarray
    """What these vertices are called in the other one, [N] int64."""
    following: int
    """Numbers from here on are free in the other one."""

    @classmethod
    def between(cls, mesh: Mesh, other: Mesh) -> "Matching":
        """Match vertices that are each other's nearest, and lie alike on the border.

        Args:
            mesh: A mesh.
            other: Another one of the same picture.
        """
        from scipy.spatial import cKDTree  # takes a second to import, and few jobs come here

        spacing = np.sqrt(mesh.width * mesh.height / mesh.vertex_count)
        distances, there = cKDTree(other.vertices).query(mesh.vertices)
        _, back = cKDTree(mesh.vertices).query(other.vertices)
        same = (back[there] == np.arange(mesh.vertex_count)) & (distances < REACH * spacing)
        same &= mesh.on_left_right == other.on_left_right[there]
        same &= mesh.on_top_bottom == other.on_top_bottom[there]
        return cls(
            known=mesh.vertex_ids[same],
            meant=other.vertex_ids[there[same]],
            following=other.next_vertex_id,
        )

    def renumbered(self, mesh: Mesh) -> Mesh:
        """A mesh of the solution with the numbers of the other one; new ones for all else.

        Args:
            mesh: A mesh.
        """
        ids = self.following + mesh.vertex_ids
        if len(self.known):
            places = np.minimum(np.searchsorted(self.known, mesh.vertex_ids), len(self.known) - 1)
            found = self.known[places] == mesh.vertex_ids
            ids = np.where(found, self.meant[places], ids)
        order = np.argsort(ids)
        rows = np.empty_like(order)
        rows[order] = np.arange(len(order))
        return replace(
            mesh,
            vertices=mesh.vertices[order],
            vertex_ids=ids[order],
            triangles=rows[mesh.triangles].astype(mesh.triangles.dtype),
            next_vertex_id=self.following + mesh.next_vertex_id,
        )
