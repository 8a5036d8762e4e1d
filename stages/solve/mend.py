"""Divide triangles that no single colour becomes, and spare as many elsewhere."""

import numpy as np

from stages.edits import collapse_edges, independent_collapses, independent_flips, split_edges
from stages.edits.neighbourhood import stars
from stages.mesh import Mesh
from stages.topology.appraise import Appraiser
from stages.topology.ranking import ranked_collapses


def divide_torn(mesh: Mesh, torn: np.ndarray, appraiser: Appraiser) -> Mesh:
    """Split the best edge of each of some triangles, and take the cheapest vertices away.

    Args:
        mesh: A valid mesh.
        torn: Triangle numbers, [N].
        appraiser: Measures it.

    Returns:
        A valid mesh, of as many triangles where vertices may go.
    """
    appraiser.energies(mesh)
    edges = 3 * torn[:, None] + np.arange(3)
    gains, points = appraiser.split_gains(edges.reshape(-1))
    best = 3 * np.arange(len(torn)) + gains.reshape(-1, 3).argmax(axis=1)
    best = best[np.argsort(-gains[best], kind="stable")]
    best = best[gains[best] > 0.0]
    if not len(best):
        return mesh
    edges, points = edges.reshape(-1)[best], points[best]
    apart = independent_flips(mesh, edges)
    divided = split_edges(mesh, edges[apart], points[apart])
    return _without(divided, divided.triangle_count - mesh.triangle_count, appraiser)


def _without(mesh: Mesh, excess: int, appraiser: Appraiser) -> Mesh:
    """Take vertices away that are missed least, but not those that came last."""
    if excess <= 0:
        return mesh
    appraiser.energies(mesh)
    going, _ = ranked_collapses(mesh, appraiser, excess)
    places, corners = stars(mesh, mesh.triangles.reshape(-1)[going])
    is_new = mesh.triangles[corners // 3].max(axis=1) >= mesh.vertex_count - excess
    going = going[np.bincount(places, weights=is_new, minlength=len(going)) == 0]
    going = going[independent_collapses(mesh, going)]
    lost = np.cumsum(np.where(mesh.twins[going] >= 0, 2, 1))
    return collapse_edges(mesh, going[: np.searchsorted(lost, excess) + 1])
