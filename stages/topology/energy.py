"""Beyond the paper: flip, collapse and split where the measured energy says so."""

from dataclasses import dataclass

import numpy as np

from stages.appraise import Appraiser
from stages.collapse import collapse_slivers
from stages.divide import divide_large
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
from stages.topology.growth import Growth

TWICE = Growth(start=1.0, peak=2.0, grown=0.2, settled=0.9)
"""Twice the triangles at first: what is then taken away, one vertex at a time, are those that
matter least, and the rest stand where the picture needs them: 5 % less error than by growth."""
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
    growth: Growth = TWICE
    """How the number of triangles develops in a first frame."""

    def adapt(self, mesh: Mesh, appraiser: Appraiser, goal: Goal) -> Mesh:
        """Collapse slivers, flip, then take vertices away and insert others.

        Args:
            mesh: A valid mesh.
            appraiser: Measures it.
            goal: What to reach.

        Deviation: the paper keeps the Delaunay property and splits at centroids (Sec. 3.4).
        """
        appraiser.limit_area(goal.largest_area)
        mesh = divide_large(mesh, goal.largest_area)
        if goal.calm:
            mesh = collapse_slivers(mesh, CALM_SLIVER_HEIGHT)
            mesh = _flip(mesh, appraiser, self.calm_flip)
            going = int(self.calm_relocated * goal.count)
            return _respend(mesh, appraiser, goal, going, self.calm_profit)
        mesh = collapse_slivers(mesh, SLIVER_HEIGHT)
        mesh = _flip(mesh, appraiser, 0.0)
        return _respend(mesh, appraiser, goal, int(self.relocated * goal.count), self.profit)


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
    """Split an independent set of edges, each at its best place, until the count is reached.

    The largest gains per triangle come first.
    """
    missing = goal.count - mesh.triangle_count
    if missing <= 0:
        return mesh
    energies = appraiser.energies(mesh)
    edges, gains, points = _ranked_splits(mesh, appraiser, energies, missing)
    wanted = gains > LEAST_GAIN
    if goal.threshold is not None:
        bad = energies > goal.threshold**2 * mesh.width * mesh.height
        wanted &= bad[edges // 3] | bad[np.maximum(mesh.twins[edges], 0) // 3]
    edges, points = edges[wanted], points[wanted]
    apart = independent_flips(mesh, edges)
    edges, points = edges[apart], points[apart]
    added = np.cumsum(np.where(mesh.twins[edges] >= 0, 2, 1))
    some = slice(np.searchsorted(added, missing) + 1)
    return split_edges(mesh, edges[some], points[some]) if len(edges) else mesh


def _ranked_splits(
    mesh: Mesh, appraiser: Appraiser, energies: np.ndarray, most: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges of the measured mesh, what a split of each saves per new triangle, and its place.

    The best come first.

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
    added = np.where(twins >= 0, 2, 1)
    beside = energies[edges // 3] + np.where(twins >= 0, energies[twins // 3], 0.0)
    likely = np.argsort(-beside / added, kind="stable")[: EXAMINED * most]
    edges = edges[likely]
    gains, points = appraiser.split_gains(edges)
    gains = gains / added[likely]
    order = np.argsort(-gains, kind="stable")
    return edges[order], gains[order], points[order]


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
    spread = np.where(mesh.on_left_right & mesh.on_top_bottom, np.inf, _spread(mesh, appraiser))
    likely = np.argsort(spread, kind="stable")[: EXAMINED * most]
    chosen = np.zeros(mesh.vertex_count, dtype=bool)
    chosen[likely] = True
    origins = mesh.triangles.reshape(-1)
    on_border = (mesh.on_left_right | mesh.on_top_bottom)[origins]
    half_edges = np.flatnonzero(chosen[origins] & (~on_border | (mesh.twins < 0)))
    lost = np.where(mesh.twins[half_edges] >= 0, 2, 1)
    costs = appraiser.collapse_costs(half_edges) / lost
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


def _respend(mesh: Mesh, appraiser: Appraiser, goal: Goal, most: int, profit: float) -> Mesh:
    """Take the vertices that are missed least and spend their triangles where they gain most.

    What exceeds the count goes whatever it costs; what is missing is spent along with the rest.

    Args:
        mesh: A valid mesh.
        appraiser: Measures it.
        goal: What to reach.
        most: Number of vertices that may go elsewhere.
        profit: How many times a gain must exceed the cost.
    """
    excess = max(0, (mesh.triangle_count - goal.count + 1) // 2)
    if most + excess == 0:
        return _split(mesh, appraiser, goal)
    energies = appraiser.energies(mesh)
    _, gains, _ = _ranked_splits(mesh, appraiser, energies, max(most, 1))
    going, costs = _ranked_collapses(mesh, appraiser, most + excess)
    legal = collapsible(mesh, going)
    going, costs = going[legal], costs[legal]
    apart = independent_collapses(mesh, going)
    going, costs = going[apart], costs[apart]
    pairs = min(max(len(going) - excess, 0), len(gains), most)
    elsewhere = gains[:pairs] > profit * costs[excess : excess + pairs]
    going = going[: excess + int(elsewhere.sum())]
    if len(going):
        mesh = collapse_edges(mesh, going)
    return _split(mesh, appraiser, goal)
