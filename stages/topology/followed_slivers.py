"""In a followed picture: which thin triangles and which without a pixel can go cheaply."""

import numpy as np

from stages.edits import independent_collapses, independent_flips
from stages.edits.collapse_edges import keeps_border
from stages.edits.neighbourhood import edge_ends, edge_triangles, stars
from stages.mesh import Mesh
from stages.topology.appraise import Appraiser
from stages.topology.collapse_slivers import heights_around, raising_flips

AFFORDED = 1.0
"""Most that one change may cost, as a part of the mean energy of a triangle: what hides between
pixels does no harm, and what is torn open for it flashes up."""


def sliver_changes(
    mesh: Mesh, appraiser: Appraiser, min_height: float, largest_area: float, free: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Collapses of slivers on the edges that cost least energy, and flips where none is cheap.

    Slivers are triangles below a height and those that cover no pixel's centre. No triangle around
    one becomes a worse sliver. What is too dear stays, and comes up again with the next look.

    Args:
        mesh: The measured mesh.
        appraiser: Has measured it.
        min_height: Triangles of a smallest height below this shall go [px].
        largest_area: No triangle may become larger [px^2].
        free: Triangles that no change has claimed yet, [T] bool; updated.

    Returns:
        Half-edges whose origins move into their destinations, and edges to flip.

    Deviation: the paper collapses small triangles on their shortest edge, whatever that does to
        the picture (Sec. 3.4).
    """
    slivers = np.flatnonzero((mesh.heights < min_height) | (appraiser.counts == 0))
    if not len(slivers):
        return slivers, slivers
    most = AFFORDED * appraiser.energies(mesh).mean()
    appraiser.limit(largest_area, is_height_free=True)
    going = _collapses(mesh, appraiser, slivers, min_height, most)
    _, corners = stars(mesh, mesh.triangles.reshape(-1)[going])
    free[corners // 3] = False
    slivers = slivers[free[slivers]]
    flips = _flips(mesh, appraiser, slivers[np.argsort(mesh.heights[slivers])], most)
    flips = flips[free[edge_triangles(mesh, flips)].all(axis=1)]
    free[edge_triangles(mesh, flips)] = False
    appraiser.limit(largest_area)
    return going, flips


def _collapses(
    mesh: Mesh, appraiser: Appraiser, slivers: np.ndarray, min_height: float, most: float
) -> np.ndarray:
    """The cheapest collapses of sides of slivers that do not touch each other."""
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
    return half_edges[independent_collapses(mesh, half_edges)]


def _flips(mesh: Mesh, appraiser: Appraiser, slivers: np.ndarray, most: float) -> np.ndarray:
    """Cheap flips of the longest sides of slivers that raise the lower triangle of the pair."""
    edges = raising_flips(mesh, slivers)
    edges = edges[appraiser.flip_gains(edges) >= -most]
    return edges[independent_flips(mesh, edges)]
