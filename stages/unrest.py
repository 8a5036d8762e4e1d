"""Where a picture changes without a motion, so that following its mesh does not pay."""

from dataclasses import dataclass
import os

import numpy as np

from stages.mesh import Mesh
from stages.snapshot import Snapshot

LO = float(os.environ.get("ULO", "1.2"))
HI = float(os.environ.get("UHI", "1.6"))
RINGS = int(os.environ.get("URINGS", "3"))


@dataclass(frozen=True, eq=False)
class Unrest:
    vertex_ids: np.ndarray
    values: np.ndarray

    @classmethod
    def between(cls, earlier: Snapshot, carried: Mesh, energies: np.ndarray) -> "Unrest":
        ids = earlier.mesh.triangle_ids
        order = np.argsort(ids)
        before = earlier.energies[order][np.searchsorted(ids[order], carried.triangle_ids)]
        eps = 0.1 * before.mean()
        corners = carried.triangles.reshape(-1)

        def around(x):
            for _ in range(RINGS - 1):
                x = np.bincount(corners, np.repeat(x, 3), carried.vertex_count)[carried.triangles].sum(axis=1) / 3
            return np.bincount(corners, np.repeat(x, 3), carried.vertex_count)

        ratio = around(energies + eps) / around(before + eps)
        return cls(carried.vertex_ids, np.clip((ratio - LO) / (HI - LO), 0.0, 1.0))

    def passed_on(self, mesh: Mesh) -> "Unrest":
        at = np.searchsorted(self.vertex_ids, mesh.vertex_ids)
        at = np.minimum(at, len(self.vertex_ids) - 1)
        known = self.vertex_ids[at] == mesh.vertex_ids
        values = np.where(known, self.values[at], 0.0)
        tails, heads = mesh.edge_vertices.T
        ends = np.concatenate([tails, heads]), np.concatenate([heads, tails])
        told = known[ends[1]]
        total = np.bincount(ends[0][told], values[ends[1][told]], mesh.vertex_count)
        count = np.bincount(ends[0][told], minlength=mesh.vertex_count)
        values[~known] = (total / np.maximum(count, 1))[~known]
        return Unrest(mesh.vertex_ids, values)

    def triangles(self, mesh: Mesh) -> np.ndarray:
        at = np.searchsorted(self.vertex_ids, mesh.vertex_ids)
        return (self.values[at][mesh.triangles] >= 0.5).all(axis=1)

    def at(self, mesh: Mesh) -> np.ndarray:
        """[T]"""
        return self.passed_on(mesh).values[mesh.triangles].min(axis=1)
