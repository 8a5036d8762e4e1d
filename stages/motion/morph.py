"""A mesh on its way to another one of the same shot: what both know goes there, the rest along."""

from dataclasses import replace

import numpy as np

from stages.mesh import Mesh, centres_of
from stages.motion.advect import sliding, unfolded
from stages.motion.correspondence import kept_vertices
from stages.snapshot import Snapshot, with_origins

LEAST_KNOWN = 8
"""With fewer vertices in common, nothing tells where a picture went."""


def morphed(snapshot: Snapshot, other: Mesh, share: float) -> Snapshot:
    """A snapshot whose vertices have gone a part of their way to where another mesh has them.

    Vertices of the same number are the same. Those that only this mesh has move as the ones around
    them do, and where triangles would fold, steps are shortened; colours move along.

    Args:
        snapshot: The snapshot.
        other: A mesh of the same shot, of the same size.
        share: The part of the way, 0 to 1.

    Returns:
        The same triangles; the very same object if nothing moves.
    """
    mesh = snapshot.mesh
    places = kept_vertices(other, mesh)
    known = places >= 0
    if share == 0.0 or known.sum() < LEAST_KNOWN:
        return snapshot
    steps = np.zeros_like(mesh.vertices)
    steps[known] = other.vertices[places[known]] - mesh.vertices[known]
    steps = share * _filled(mesh, steps, known)
    moved = mesh.moved(mesh.vertices + unfolded(mesh, sliding(mesh, steps)))
    colors = with_origins(snapshot.model, snapshot.coefficients, centres_of(mesh.corners))
    coefficients = with_origins(snapshot.model, colors, -centres_of(moved.corners))
    return replace(snapshot, mesh=moved, coefficients=coefficients)


def _filled(mesh: Mesh, steps: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Steps of all vertices: each that is not known takes the mean of its neighbours' [px], [V, 2].

    Args:
        mesh: A mesh, which hangs together.
        steps: Those of the known ones [px], [V, 2].
        known: Which are known, [V] bool, at least one.
    """
    from scipy.sparse import coo_array, diags_array  # slow to import, and few jobs come here
    from scipy.sparse.linalg import spsolve

    count = mesh.vertex_count
    one, other = mesh.edge_vertices.T
    ends = np.concatenate([one, other]), np.concatenate([other, one])
    beside = coo_array((np.ones(len(ends[0])), ends), shape=(count, count)).tocsr()
    open_ = np.flatnonzero(~known)
    if not len(open_):
        return steps
    degrees = diags_array(np.asarray(beside.sum(axis=1)).ravel()[open_])
    matrix = (degrees - beside[open_][:, open_]).tocsc()
    drawn = beside[open_] @ np.where(known[:, None], steps, 0.0)
    filled = steps.copy()
    for axis in range(2):
        filled[open_, axis] = spsolve(matrix, drawn[:, axis])
    return filled
