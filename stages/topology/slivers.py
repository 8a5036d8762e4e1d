"""In a followed picture: take away thin triangles and those without a pixel where it is cheap."""

import numpy as np

from stages.appraise import Appraiser
from stages.collapse import heights_around, press_slivers, raising_flips
from stages.edits import collapse_edges, flip_edges, independent_collapses, independent_flips
from stages.edits.collapse_edges import keeps_border
from stages.edits.neighbourhood import edge_ends
from stages.mesh import Mesh

ROUNDS = 2
"""Rounds of edits: what is left comes up again with the next look at the topology."""
AFFORDED = 1.0
"""Most that one change may cost, as a part of the mean energy of a triangle: what hides between
pixels does no harm, and what is torn open for it flashes up."""


def remove_slivers(
    mesh: Mesh, appraiser: Appraiser, min_height: float, largest_area: float
) -> Mesh:
    """Collapse slivers on the edge that costs least energy, or flip them, where that costs little.

    Slivers are triangles below a height and those that cover no pixel's centre. Thin ones that lie
    flat on the border are pressed onto it.

    Args:
        mesh: A valid mesh.
        appraiser: Measures it.
        min_height: Triangles of a smallest height below this shall go [px].
        largest_area: No triangle may become larger [px^2].

    Returns:
        A valid mesh with as many triangles or fewer.

    Deviation: the paper collapses small triangles on their shortest edge, whatever that does to
        the picture (Sec. 3.4).
    """
    for _ in range(ROUNDS):
        appraiser.limit(largest_area, is_height_free=True)
        most = AFFORDED * appraiser.energies(mesh).mean()
        thin = mesh.heights < min_height
        slivers = np.flatnonzero(thin | (appraiser.counts == 0))
        if not len(slivers):
            break
        mended = press_slivers(mesh, np.flatnonzero(thin), min_height)
        if mended is mesh:
            mended = _collapse(mesh, appraiser, slivers, min_height, most)
        if mended is mesh:
            mended = _flip(mesh, appraiser, slivers, most)
        if mended is mesh:
            break
        mesh = mended
    appraiser.limit(largest_area)
    return mesh


def _collapse(
    mesh: Mesh, appraiser: Appraiser, slivers: np.ndarray, min_height: float, most: float
) -> Mesh:
    """Collapse edges of slivers, the cheapest first; no triangle becomes a worse sliver."""
    sides = (3 * slivers[:, None] + np.arange(3)).reshape(-1)
    twins = mesh.twins[sides]
    half_edges = np.unique(np.concatenate([sides, twins[twins >= 0]]))
    origins, destinations = edge_ends(mesh, half_edges, None)
    before, after = heights_around(mesh, origins, destinations)
    legal = keeps_border(mesh, half_edges, origins)
    legal &= (after > 0) & (after >= np.minimum(before, min_height))
    half_edges = half_edges[legal]
    costs = appraiser.collapse_costs(half_edges)
    half_edges = half_edges[np.argsort(costs, kind="stable")[: (costs <= most).sum()]]
    half_edges = half_edges[independent_collapses(mesh, half_edges)]
    return collapse_edges(mesh, half_edges) if len(half_edges) else mesh


def _flip(mesh: Mesh, appraiser: Appraiser, slivers: np.ndarray, most: float) -> Mesh:
    """Flip the longest edges of slivers where that raises the lower triangle of the pair."""
    edges = raising_flips(mesh, slivers[np.argsort(mesh.heights[slivers], kind="stable")])
    if not len(edges):
        return mesh
    edges = edges[appraiser.flip_gains(edges) >= -most]
    edges = edges[independent_flips(mesh, edges)]
    return flip_edges(mesh, edges) if len(edges) else mesh
