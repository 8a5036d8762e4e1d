"""Carry a mesh from one frame to the next along the flow."""

from dataclasses import dataclass

import numpy as np

from stages.flows.passage import Passage
from stages.hand.locks import NO_LOCKS, Locks
from stages.hand.worked import Worked
from stages.mesh import Mesh, heights_of
from stages.motion.held_path import held_path
from stages.motion.occlusion import collapse_covered

LOWEST = 0.25
"""The flow may thin a triangle down to this height [px]; a lower one it does not thin further."""
HALVINGS = 6
"""A vertex that still folds a triangle after this many halvings of its step stays behind."""


@dataclass(frozen=True, eq=False)
class Carried:
    """A mesh that has come along from the frame before."""

    mesh: Mesh
    """The mesh, where the motion has taken it."""
    trust: np.ndarray
    """How far that is where each vertex belongs [0..1], shape [V]."""
    patches: np.ndarray | None = None
    """How badly the patches around the vertices fit where they are now, and their contrast [code
    values], shape [V, 2]; None if that is not known."""
    locks: Locks = NO_LOCKS
    """What of it a person holds fast."""
    friction: np.ndarray | None = None
    """How far each vertex must be drawn before it leaves its place [px], shape [V]; None for not
    at all."""

    @classmethod
    def by_hand(cls, worked: Worked) -> "Carried":
        """A mesh that a person has worked on: all of it is where it belongs.

        Args:
            worked: The mesh, and what of it is held fast.
        """
        return cls(worked.mesh, np.ones(worked.mesh.vertex_count), locks=worked.locks)


def advect(mesh: Mesh, passage: Passage, locks: Locks = NO_LOCKS) -> Carried:
    """Move every vertex by the motion of the picture under it.

    Border vertices slide along their border, corners stay. Triangles that would fold are covered
    and collapse; where that cannot be, the steps of their vertices are halved until they do not
    fold.

    Args:
        mesh: A valid mesh.
        passage: Leads from the mesh's frame to the next.
        locks: What of the mesh a person holds fast: it goes along as well, and vanishes only where
            it is covered.

    Returns:
        A valid mesh of the same triangles or fewer; ids are kept.

    Source: the paper starts a frame from the last one's mesh (Lawonn & Guenther, Stylized Image
        Triangulation, 2018, Sec. 6.3).
    Deviation: it does not move that mesh; the flow lets vertices follow fast motion.
    """
    steps, trust = passage.follow(mesh.vertices)
    if not locks.is_empty:
        steps, locks = held_path(mesh, steps, passage, locks)
    kept, steps = collapse_covered(mesh, sliding(mesh, steps), LOWEST, locks.vertices)
    places = np.searchsorted(mesh.vertex_ids, kept.vertex_ids)  # ids ascend with the rows
    steps = unfolded(kept, steps)
    patches = passage.unlikeness(kept.vertices, steps)
    there = kept.moved(kept.vertices + steps)
    return Carried(there, trust[places], patches, locks.within(there))


def sliding(mesh: Mesh, steps: np.ndarray) -> np.ndarray:
    """Steps that keep vertices in the domain and border vertices on their border.

    Args:
        mesh: A valid mesh.
        steps: Motion of every vertex [px], shape [V, 2].

    Returns:
        Steps [px], shape [V, 2].
    """
    fixed = np.stack([mesh.on_left_right, mesh.on_top_bottom], axis=1)
    goals = np.clip(mesh.vertices + steps, 0, (mesh.width, mesh.height))
    return np.where(fixed, 0.0, goals - mesh.vertices)


def unfolded(mesh: Mesh, steps: np.ndarray) -> np.ndarray:
    """Shorten steps until no triangle folds.

    Args:
        mesh: A valid mesh.
        steps: Motion of every vertex that respects the border [px], shape [V, 2].

    Returns:
        Steps [px], shape [V, 2], which leave every triangle at least `LOWEST` or its height
        before.
    """
    floor = np.minimum(LOWEST, (1.0 - 1e-9) * mesh.heights)  # but for rounding
    halved = np.zeros(mesh.vertex_count, dtype=np.int64)
    shorter = steps
    # Ends because a triangle of three vertices at rest has its height from before.
    while True:
        folding = heights_of((mesh.vertices + shorter)[mesh.triangles]) < floor
        if not folding.any():
            return shorter
        halved[np.unique(mesh.triangles[folding])] += 1
        share = np.where(halved > HALVINGS, 0.0, 0.5**halved)
        shorter = share[:, None] * steps
