"""Beyond the paper: flip, collapse and split where the measured energy says so."""

from dataclasses import dataclass

import numpy as np

from stages.appraise import Appraiser
from stages.collapse import collapse_slivers
from stages.edits import (
    collapse_edges,
    collapsible,
    flip_edges,
    flippable,
    independent_collapses,
    independent_flips,
    split_edges,
)
from stages.mesh import Mesh
from stages.topology.goal import SLIVER_HEIGHT, Goal

FLIP_PASSES = 2
"""Independent sets of flips that one round applies, each measured anew."""
LEAST_GAIN = 1.0
"""Changes that save less than this are rounding [code value^2 px]."""
CALM_SLIVER_HEIGHT = 0.3
"""In a followed picture triangles thinner than this collapse [px]; a higher bar would make those
that hover about it come and go."""
EXAMINED = 8
"""Cheapest collapses looked at for each one wanted: some are illegal or touch each other."""


@dataclass(frozen=True)
class Energy:
    """Changes that lower the energy, so that every triangle is spent where it pays most."""

    relocated: float = 0.05
    """Most vertices that one round moves elsewhere, as a part of the triangles."""
    profit: float = 1.5
    """A vertex moves elsewhere if its gain there exceeds its cost here this many times."""
    calm_flip: float = 0.05
    """In a followed picture a flip must save this part of its two triangles' energy."""
    calm_relocated: float = 0.015
    """As `relocated`, in a followed picture."""
    calm_profit: float = 3.0
    """As `profit`, in a followed picture."""

    def adapt(self, mesh: Mesh, appraiser: Appraiser, goal: Goal) -> Mesh:
        """Collapse slivers, flip, split up to the count, then relocate.

        Args:
            mesh: A valid mesh.
            appraiser: Measures it.
            goal: What to reach.

        Deviation: the paper keeps the Delaunay property and splits at centroids (Sec. 3.4).
        """
        if goal.calm:
            mesh = collapse_slivers(mesh, CALM_SLIVER_HEIGHT)
            mesh = _flip(mesh, appraiser, self.calm_flip)
            going = int(self.calm_relocated * goal.count)
            return _relocate(mesh, appraiser, goal, going, self.calm_profit)
        mesh = collapse_slivers(mesh, SLIVER_HEIGHT)
        for _ in range(FLIP_PASSES):
            mesh = _flip(mesh, appraiser, 0.0)
        mesh = _split(mesh, appraiser, goal)
        return _relocate(mesh, appraiser, goal, int(self.relocated * goal.count), self.profit)


def _flip(mesh: Mesh, appraiser: Appraiser, least_share: float) -> Mesh:
    """Flip an independent set of edges, the largest gains first.

    Args:
        mesh: A valid mesh.
        appraiser: Measures it.
        least_share: Smallest gain, as a part of the energy of the edge's two triangles.
    """
    energies = appraiser.energies(mesh)
    edges = mesh.edge_half_edges
    gains = appraiser.flip_gains(edges)
    before = energies[edges // 3] + energies[np.maximum(mesh.twins[edges], 0) // 3]
    wanted = gains > np.maximum(least_share * before, LEAST_GAIN)
    edges, gains = edges[wanted], gains[wanted]
    edges = edges[np.argsort(-gains, kind="stable")]
    edges = edges[flippable(mesh, edges)]
    edges = edges[independent_flips(mesh, edges)]
    return flip_edges(mesh, edges) if len(edges) else mesh


def _split(mesh: Mesh, appraiser: Appraiser, goal: Goal) -> Mesh:
    """Split an independent set of edges in the middle, the largest gains per triangle first."""
    missing = goal.count - mesh.triangle_count
    if missing <= 0:
        return mesh
    energies = appraiser.energies(mesh)
    edges, gains = _ranked_splits(mesh, appraiser, energies, missing)
    if goal.threshold is not None:
        bad = energies > goal.threshold**2 * mesh.width * mesh.height
        beside = bad[edges // 3] | bad[np.maximum(mesh.twins[edges], 0) // 3]
        edges, gains = edges[beside], gains[beside]
    edges = edges[gains > LEAST_GAIN]
    edges = edges[independent_flips(mesh, edges)]
    added = np.cumsum(np.where(mesh.twins[edges] >= 0, 2, 1))
    edges = edges[: np.searchsorted(added, missing) + 1]
    return split_edges(mesh, edges) if len(edges) else mesh


def _ranked_splits(
    mesh: Mesh, appraiser: Appraiser, energies: np.ndarray, most: int
) -> tuple[np.ndarray, np.ndarray]:
    """Edges of the measured mesh and what a split of each saves per new triangle, best first.

    A split cannot save more than the energy of the triangles beside it, so only the edges with
    the largest energies beside them are measured.

    Args:
        mesh: The measured mesh.
        appraiser: Has measured it.
        energies: E(T) [code value^2 px], [T].
        most: Number of edges worth knowing.
    """
    edges = mesh.edge_half_edges
    twins = mesh.twins[edges]
    beside = energies[edges // 3] + np.where(twins >= 0, energies[twins // 3], 0.0)
    likely = np.argsort(-beside, kind="stable")[: EXAMINED * most]
    edges = edges[likely]
    gains = appraiser.split_gains(edges) / np.where(twins[likely] >= 0, 2, 1)
    order = np.argsort(-gains, kind="stable")
    return edges[order], gains[order]


def _ranked_collapses(mesh: Mesh, appraiser: Appraiser, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Half-edges of the measured mesh and what each collapse costs per lost triangle, best first.

    If all triangles around a vertex took one colour, the energy would grow by the spread of their
    colours; no collapse of the vertex costs more. Only the vertices with the smallest spread are
    measured.

    Args:
        mesh: The measured mesh.
        appraiser: Has measured it.
        most: Number of vertices that may go.
    """
    likely = np.argsort(_spread(mesh, appraiser), kind="stable")[: EXAMINED * most]
    chosen = np.zeros(mesh.vertex_count, dtype=bool)
    chosen[likely] = True
    half_edges = np.flatnonzero(chosen[mesh.triangles.reshape(-1)])
    costs = appraiser.collapse_costs(half_edges) / 2
    order = np.argsort(costs, kind="stable")[: EXAMINED * most]
    return half_edges[order], costs[order]


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


def _relocate(mesh: Mesh, appraiser: Appraiser, goal: Goal, most: int, profit: float) -> Mesh:
    """Take the vertices that are missed least and spend their triangles where they gain most.

    Triangles that are missing already are spent along with them.

    Args:
        mesh: A valid mesh.
        appraiser: Measures it.
        goal: What to reach.
        most: Number of vertices that may go.
        profit: How many times a gain must exceed the cost.
    """
    if most < 1:
        return _split(mesh, appraiser, goal)
    energies = appraiser.energies(mesh)
    _, gains = _ranked_splits(mesh, appraiser, energies, most)
    going, costs = _ranked_collapses(mesh, appraiser, most)
    tempting = profit * costs < gains[0]
    going, costs = going[tempting], costs[tempting]
    legal = collapsible(mesh, going)
    going, costs = going[legal], costs[legal]
    apart = independent_collapses(mesh, going)
    going, costs = going[apart][:most], costs[apart][:most]
    pairs = min(len(going), len(gains))
    going = going[: int((gains[:pairs] > profit * costs[:pairs]).sum())]
    if len(going):
        mesh = collapse_edges(mesh, going)
    return _split(mesh, appraiser, goal)
