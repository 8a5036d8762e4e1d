"""Candidates for changes of topology, best first; what cannot be worth it is not measured."""

import numpy as np

from stages.edits.collapse_edges import keeps_border
from stages.mesh import Mesh
from stages.topology.appraise import Appraiser
from warp_kernels.energy.topology_gains import IMPOSSIBLE

LEAST_GAIN = 1.0
"""Changes that save less than this are rounding [code value^2 px]."""
EXAMINED = 8
"""Candidates measured for each one wanted: some are illegal or touch each other."""
BARRED = 0.5 * IMPOSSIBLE
"""From this on a cost says that a collapse is none [code value^2 px]."""
LEAST_EXAMINED = 100
"""Splits measured at least: where few are wanted all of eight may touch other changes."""


def ranked_flips(
    mesh: Mesh,
    appraiser: Appraiser,
    least_share: float,
    floor: float,
    calm: np.ndarray | None = None,
    beside: np.ndarray | None = None,
) -> np.ndarray:
    """Edges of the measured mesh whose flip pays.

    Args:
        mesh: The measured mesh.
        appraiser: Has measured it.
        least_share: Smallest gain, as a part of the energy of the edge's two triangles.
        floor: Smallest gain, where errors count as on the whole [code value^2 px].
        calm: How much of both counts at each triangle [0..1], [T]; None for all of it.
        beside: Triangles of which an edge must be one, [T] bool; None for all.
    """
    energies = appraiser.energies(mesh)
    edges = mesh.edge_half_edges
    if beside is not None:
        edges = edges[beside_edges(mesh, beside, edges)]
    gains = appraiser.flip_gains(edges)
    before = energies[edges // 3] + energies[np.maximum(mesh.twins[edges], 0) // 3]
    least = np.maximum(least_share * before, floor * appraiser.emphasis(edges))
    if calm is not None:
        least *= beside_edges(mesh, calm, edges)
    wanted = gains > np.maximum(least, LEAST_GAIN)
    edges, gains = edges[wanted], gains[wanted]
    return edges[np.argsort(-gains, kind="stable")]


def ranked_splits(
    mesh: Mesh, appraiser: Appraiser, most: int, within: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges of the measured mesh, what a split of each saves per new triangle, and its place.

    The best come first.

    A split cannot save more than the energy of the triangles beside it, so only the edges with
    the largest energies beside them are measured.

    Args:
        mesh: The measured mesh.
        appraiser: Has measured it.
        most: Number of edges worth knowing.
        within: Triangles that may be split, [T] bool; None for all.
    """
    energies = appraiser.energies(mesh)
    edges = mesh.edge_half_edges
    if within is not None:
        edges = edges[~beside_edges(mesh, ~within, edges)]
    if appraiser.held is not None:
        edges = edges[~appraiser.held.undivided[edges]]
    twins = mesh.twins[edges]
    added = np.where(twins >= 0, 2, 1)
    beside = energies[edges // 3] + np.where(twins >= 0, energies[twins // 3], 0.0)
    examined = max(EXAMINED * most, LEAST_EXAMINED)
    likely = np.argsort(-beside / added, kind="stable")[:examined]
    edges = edges[likely]
    gains, points = appraiser.split_gains(edges)
    gains = gains / added[likely]
    order = np.argsort(-gains, kind="stable")
    return edges[order], gains[order], points[order]


def ranked_collapses(
    mesh: Mesh, appraiser: Appraiser, most: int, worth: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Half-edges of the measured mesh and what each collapse costs per lost triangle, best first.

    If all triangles around a vertex took one colour, the energy would grow by the spread of their
    colours; no collapse of the vertex costs more. Only the vertices with the smallest spread are
    measured.

    Args:
        mesh: The measured mesh.
        appraiser: Has measured it.
        most: Number of vertices that may go.
        worth: Factor of the costs at each vertex, [V]; None for 1.
    """
    spread = np.where(mesh.on_left_right & mesh.on_top_bottom, np.inf, _spread(mesh, appraiser))
    if appraiser.held is not None:
        spread[appraiser.held.kept] = np.inf
    if worth is not None:
        spread *= worth
    likely = np.argsort(spread, kind="stable")[: EXAMINED * most]
    chosen = np.zeros(mesh.vertex_count, dtype=bool)
    chosen[likely] = True
    origins = mesh.triangles.reshape(-1)
    half_edges = np.flatnonzero(chosen[origins])
    half_edges = half_edges[keeps_border(mesh, half_edges, origins[half_edges])]
    costs = appraiser.collapse_costs(half_edges)
    half_edges, costs = half_edges[costs < BARRED], costs[costs < BARRED]
    costs /= np.where(mesh.twins[half_edges] >= 0, 2, 1)
    if worth is not None:
        costs *= worth[origins[half_edges]]
    order = np.argsort(costs, kind="stable")[: EXAMINED * most]
    return half_edges[order], costs[order]


def beside_edges(mesh: Mesh, values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """The larger value of the triangles beside each edge.

    Args:
        mesh: A mesh.
        values: One for each triangle, shape [T].
        edges: Half-edges, shape [N].
    """
    twins = mesh.twins[edges]
    own = values[edges // 3]
    return np.where(twins >= 0, np.maximum(own, values[twins // 3]), own)


def _spread(mesh: Mesh, appraiser: Appraiser) -> np.ndarray:
    """Spread of the mean colours around each vertex, weighted by pixels [code value^2 px], [V]."""
    corners = mesh.triangles.reshape(-1)
    weights = np.repeat(appraiser.counts.astype(np.float64), 3)
    colors = np.repeat(appraiser.colors, 3, axis=0)

    def around(values: np.ndarray) -> np.ndarray:
        """Sum over the corners at every vertex."""
        return np.bincount(corners, weights=values, minlength=mesh.vertex_count)

    total = np.maximum(around(weights), 1.0)
    spread = around(weights * (colors**2).sum(axis=1))
    for channel in range(colors.shape[1]):
        spread -= around(weights * colors[:, channel]) ** 2 / total
    return 0.5 * spread
