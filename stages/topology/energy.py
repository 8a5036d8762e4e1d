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
    calm_relocated: float = 0.005
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
        mesh = collapse_slivers(mesh, SLIVER_HEIGHT)
        for _ in range(1 if goal.calm else FLIP_PASSES):
            mesh = _flip(mesh, appraiser, self.calm_flip if goal.calm else 0.0)
        mesh = _split(mesh, appraiser, goal)
        share = self.calm_relocated if goal.calm else self.relocated
        profit = self.calm_profit if goal.calm else self.profit
        return _relocate(mesh, appraiser, goal, int(share * goal.count), profit)


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
    edges, gains = _ranked_splits(mesh, appraiser)
    if goal.threshold is not None:
        bad = energies > goal.threshold**2 * mesh.width * mesh.height
        beside = bad[edges // 3] | bad[np.maximum(mesh.twins[edges], 0) // 3]
        edges, gains = edges[beside], gains[beside]
    edges = edges[gains > LEAST_GAIN]
    edges = edges[independent_flips(mesh, edges)]
    added = np.cumsum(np.where(mesh.twins[edges] >= 0, 2, 1))
    edges = edges[: np.searchsorted(added, missing) + 1]
    return split_edges(mesh, edges) if len(edges) else mesh


def _ranked_splits(mesh: Mesh, appraiser: Appraiser) -> tuple[np.ndarray, np.ndarray]:
    """Edges of the measured mesh and what a split of each saves per new triangle, best first."""
    edges = mesh.edge_half_edges
    gains = appraiser.split_gains(edges) / np.where(mesh.twins[edges] >= 0, 2, 1)
    order = np.argsort(-gains, kind="stable")
    return edges[order], gains[order]


def _relocate(mesh: Mesh, appraiser: Appraiser, goal: Goal, most: int, profit: float) -> Mesh:
    """Take the vertices that are missed least and spend their triangles where they gain most.

    Args:
        mesh: A valid mesh.
        appraiser: Measures it.
        goal: What to reach.
        most: Number of vertices that may go.
        profit: How many times a gain must exceed the cost.
    """
    appraiser.energies(mesh)
    _, gains = _ranked_splits(mesh, appraiser)
    half_edges = np.arange(3 * mesh.triangle_count)
    costs = appraiser.collapse_costs(half_edges) / 2
    cheapest = np.argsort(costs, kind="stable")[: EXAMINED * most]
    cheapest = cheapest[profit * costs[cheapest] < gains[0]]
    cheapest = cheapest[collapsible(mesh, half_edges[cheapest])]
    cheapest = cheapest[independent_collapses(mesh, half_edges[cheapest])][:most]
    worthwhile = gains[: len(cheapest)] > profit * costs[cheapest[: len(gains)]]
    going = cheapest[: int(worthwhile.sum())]
    if not len(going):
        return mesh
    smaller = collapse_edges(mesh, half_edges[going])
    return _split(smaller, appraiser, goal)
