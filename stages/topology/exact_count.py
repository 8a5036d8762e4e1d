"""Bring a mesh to exactly the number of triangles that was asked for.

Changes inside come in pairs of triangles, and the rounds of a topology may stop one short of the
goal or one beyond it: only a change along the border adds or takes a single one.
"""

import numpy as np

from stages.edits import collapse_edges, independent_collapses, independent_flips, split_edges
from stages.mesh import Mesh
from stages.topology.appraise import Appraiser
from stages.topology.ranking import BARRED, ranked_collapses, ranked_splits

MOST_ROUNDS = 8
"""Rounds of edits, each as many as do not touch; one or two are usual."""


def with_exactly(count: int, mesh: Mesh, appraiser: Appraiser) -> Mesh:
    """Split the edges that gain most, or take away the vertices that are missed least.

    Args:
        count: Wanted number of triangles.
        mesh: A valid mesh.
        appraiser: Measures it; its limits hold.

    Returns:
        A valid mesh of as many triangles, as far as any change is possible; the same object if
        nothing is to be done.
    """
    for _ in range(MOST_ROUNDS):
        missing = count - mesh.triangle_count
        if missing == 0:
            break
        changed = mesh
        if missing % 2:
            changed = _along_border(mesh, appraiser, missing)
        elif missing > 0:
            changed = _with_more(mesh, appraiser, missing // 2)
        else:
            changed = _with_fewer(mesh, appraiser, -missing // 2)
        if changed is mesh:
            break
        mesh = changed
    return mesh


def _along_border(mesh: Mesh, appraiser: Appraiser, missing: int) -> Mesh:
    """One triangle more, or one less if that is wanted and possible."""
    appraiser.energies(mesh)
    edges = np.flatnonzero(mesh.twins < 0)
    if missing < 0:
        origins = mesh.triangles.reshape(-1)[edges]
        going = edges[~(mesh.on_left_right[origins] & mesh.on_top_bottom[origins])]
        costs = appraiser.collapse_costs(going)
        if len(going) and costs.min() < BARRED:
            return collapse_edges(mesh, going[[costs.argmin()]])
    gains, points = appraiser.split_gains(edges)
    best = gains.argmax()
    if gains[best] <= -BARRED:
        return mesh
    return split_edges(mesh, edges[[best]], points[[best]])


def _with_more(mesh: Mesh, appraiser: Appraiser, pairs: int) -> Mesh:
    """Split inner edges, the best first."""
    edges, gains, points = ranked_splits(mesh, appraiser, pairs)
    possible = (mesh.twins[edges] >= 0) & (gains > -BARRED)
    edges, points = edges[possible], points[possible]
    apart = np.flatnonzero(independent_flips(mesh, edges))[:pairs]
    return split_edges(mesh, edges[apart], points[apart]) if len(apart) else mesh


def _with_fewer(mesh: Mesh, appraiser: Appraiser, pairs: int) -> Mesh:
    """Take inner vertices away, the cheapest first."""
    appraiser.energies(mesh)
    going, _ = ranked_collapses(mesh, appraiser, pairs)
    going = going[mesh.twins[going] >= 0]
    apart = np.flatnonzero(independent_collapses(mesh, going))[:pairs]
    return collapse_edges(mesh, going[apart]) if len(apart) else mesh
