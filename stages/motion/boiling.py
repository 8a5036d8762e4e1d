"""Where a picture boils: it changes without a motion, so that following its mesh does not pay."""

from dataclasses import dataclass, replace

import numpy as np

from stages.mesh import Mesh
from stages.motion.advect import Carried
from stages.snapshot import Snapshot

WORSE = 1.15, 1.45
"""Triangles that came along and lack less than the first number times what they lacked before are
well followed; from the second one on their places mean nothing any more."""
STRANGE = 0.15, 0.35
"""The same for the misfit of patches as a part of their contrast: that of patches which have
nothing to do with each other is about 1, and of what moves fast, or under grain, 0.1 to 0.3."""
RINGS = 4
"""Both are told by the triangles that can be reached over so many edges: a single one may fit
badly wherever something moves."""
FAINT_ENERGY = 0.1
"""What lacks less than this part of a triangle's mean energy is not worth any trouble."""
FAINT_CONTRAST = 2.0
"""Contrast below this is noise [code values]."""
LEAST_SHARE = 0.12
"""Where less than this part of the triangles boils it is left as it is: that may as well be a
limb that moves fast, or what was just uncovered, and a frame that is refined anew takes half as
long again."""


@dataclass(frozen=True, eq=False)
class Unrest:
    """How much the picture boils around the vertices of a mesh."""

    vertex_ids: np.ndarray
    """Their persistent numbers, ascending, shape [V]."""
    values: np.ndarray
    """From 0, where it is calm or moves, to 1, where it boils; shape [V]."""

    @classmethod
    def between(cls, earlier: Snapshot, carried: Carried, energies: np.ndarray) -> "Unrest | None":
        """Compare how triangles fit with how they did in the frame before.

        A picture under grain looks unlike the one before as well, but its triangles fit as they
        did; those of something that moves too fast fit worse, but their patches are found.

        Args:
            earlier: The frame before.
            carried: Its mesh as it came along.
            energies: E(T) there, measured as those of `earlier` [code value^2 px], shape [T].

        Returns:
            None where next to nothing boils, or where nothing is known of the patches.
        """
        if carried.patches is None:
            return None
        mesh = carried.mesh
        before = _kept(earlier, mesh)
        faint = FAINT_ENERGY * before.mean()
        if not faint > 0:
            return None
        worse = _around(mesh, energies + faint) / _around(mesh, before + faint)
        found = cls(mesh.vertex_ids, _ramp(worse, *WORSE))
        if not found.is_worth_it(mesh):
            return None
        misfits, contrasts = carried.patches.astype(np.float64).T
        strange = _around(mesh, misfits[mesh.triangles].sum(axis=1))
        strange /= _around(mesh, (contrasts + FAINT_CONTRAST)[mesh.triangles].sum(axis=1))
        found = cls(mesh.vertex_ids, found.values * _ramp(strange, *STRANGE))
        return found if found.is_worth_it(mesh) else None

    @classmethod
    def everywhere(cls, mesh: Mesh) -> "Unrest":
        """All of a mesh may change, though nothing boils.

        Args:
            mesh: The mesh.
        """
        return cls(mesh.vertex_ids, np.ones(mesh.vertex_count))

    def at(self, mesh: Mesh) -> np.ndarray:
        """How much it boils around the vertices of what has become of the mesh, shape [V].

        New ones are like those around them.

        Args:
            mesh: The mesh after any edits.
        """
        if np.array_equal(self.vertex_ids, mesh.vertex_ids):
            return self.values
        places = np.searchsorted(self.vertex_ids, mesh.vertex_ids)
        places = np.minimum(places, len(self.vertex_ids) - 1)
        told = self.vertex_ids[places] == mesh.vertex_ids
        values = np.where(told, self.values[places], 0.0)
        tails, heads = mesh.edge_vertices.T
        ends = np.concatenate([tails, heads]), np.concatenate([heads, tails])
        while not told.all():
            asks = ~told[ends[0]] & told[ends[1]]
            asking, told_by = ends[0][asks], ends[1][asks]
            if not len(asking):
                break  # nothing is left of the mesh
            counts = np.bincount(asking, minlength=mesh.vertex_count)
            sums = np.bincount(asking, values[told_by], mesh.vertex_count)
            values = np.where(counts > 0, sums / np.maximum(counts, 1), values)
            told |= counts > 0
        return values

    def passed_on(self, mesh: Mesh) -> "Unrest":
        """The same for what has become of the mesh, so that it need not be worked out again.

        Args:
            mesh: The mesh after any edits.
        """
        return Unrest(mesh.vertex_ids, self.at(mesh))

    def freed(self, carried: Carried) -> Carried:
        """A mesh as it came along, with springs that let go where it boils.

        Args:
            carried: The mesh that was compared.
        """
        return replace(carried, trust=carried.trust * (1.0 - self.values))

    def calm(self, mesh: Mesh) -> np.ndarray:
        """How calm it is at the calmest corner of each triangle [0..1], shape [T].

        Args:
            mesh: The mesh after any edits.
        """
        return 1.0 - self.at(mesh)[mesh.triangles].min(axis=1)

    def boiling(self, mesh: Mesh) -> np.ndarray:
        """Triangles that rather boil than not, shape [T] bool.

        Args:
            mesh: The mesh after any edits.
        """
        return self.calm(mesh) <= 0.5

    def is_worth_it(self, mesh: Mesh) -> bool:
        """Whether so much boils that something should be done.

        Args:
            mesh: The mesh after any edits.
        """
        return bool(self.boiling(mesh).mean() >= LEAST_SHARE)


def _kept(earlier: Snapshot, mesh: Mesh) -> np.ndarray:
    """Energies that the triangles of a carried mesh had in the frame before, shape [T]."""
    ids = earlier.mesh.triangle_ids
    order = np.argsort(ids, kind="stable")
    return earlier.energies[order[np.searchsorted(ids[order], mesh.triangle_ids)]]


def _around(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """Sums over the triangles around each vertex, those close by counted more often.

    Args:
        mesh: A mesh.
        values: One for each triangle, shape [T].

    Returns:
        Shape [V].
    """
    corners = mesh.triangles.reshape(-1)
    sums = np.bincount(corners, np.repeat(values, 3), mesh.vertex_count)
    for _ in range(RINGS - 1):
        spread = np.repeat(sums[mesh.triangles].sum(axis=1), 3)
        sums = np.bincount(corners, spread, mesh.vertex_count)
    return sums


def _ramp(values: np.ndarray, begin: float, end: float) -> np.ndarray:
    """0 up to one value and 1 from another one on."""
    return np.clip((values - begin) / (end - begin), 0.0, 1.0)
