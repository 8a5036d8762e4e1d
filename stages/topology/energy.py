"""Beyond the paper: flip, collapse and split where the measured energy says so."""

from dataclasses import dataclass, replace

import numpy as np

from stages.edits import (
    collapse_edges,
    flip_edges,
    independent_collapses,
    independent_flips,
    split_edges,
)
from stages.edits.neighbourhood import edge_triangles, stars
from stages.mesh import Mesh
from stages.topology.appraise import Appraiser
from stages.topology.area_limit import divide_large
from stages.topology.collapse_slivers import collapse_slivers, press_slivers
from stages.topology.followed_slivers import sliver_changes
from stages.topology.goal import SLIVER_HEIGHT, Goal
from stages.topology.growth import Growth
from stages.topology.ranking import (
    LEAST_GAIN,
    beside_edges,
    ranked_collapses,
    ranked_flips,
    ranked_splits,
)

TWICE = Growth(start=1.0, peak=2.0, grown=0.2, settled=0.9)
"""Twice the triangles at first: what is then taken away, one vertex at a time, are those that
matter least, and the rest stand where the picture needs them: 5 % less error than by growth."""
ANEW = Growth(start=1.0, peak=2.5, grown=0.2, settled=0.9)
"""The same with fewer iterations, from triangles that stand in wrong places."""
CALM_SLIVER_HEIGHT = 0.3
"""In a followed picture triangles thinner than this collapse [px]; a higher bar would make those
that hover about it come and go."""

SLIVER_ROUNDS = 3
"""Rounds in which slivers of a first frame collapse; with one alone some starts end in worse
places."""
GROWING = 0.02
"""Where more than this part of the triangles is missing, flips come before all else and no vertex
moves elsewhere."""


@dataclass(frozen=True)
class Energy:
    """Changes that lower the energy, so that every triangle is spent where it pays most."""

    relocated: float = 0.05
    """Most vertices that one round moves elsewhere, as a part of the triangles."""
    profit: float = 1.5
    """A vertex moves elsewhere if its gain there exceeds its cost here this many times."""
    flip: float = 0.0
    """In a first frame a flip must save this part of its two triangles' energy."""
    calm_flip: float = 0.01
    """In a followed picture a flip must save this part of its two triangles' energy."""
    calm_flip_floor: float = 0.04
    """And this part of the mean energy of a triangle: what saves less only flickers."""
    calm_floor: float = 0.6
    """In a followed picture a vertex moves elsewhere only for this gain per triangle there, as a
    part of the mean energy of a triangle."""
    calm_relocated: float = 0.06
    """As `relocated`, in a followed picture."""
    beside_boiling: float = 0.015
    """As `calm_relocated`, where it is calm in a picture that boils in places: such a picture is
    looked at more often."""
    calm_profit: float = 1.4
    """As `profit`, in a followed picture."""
    floor_beside_boiling: float = 1.0
    """As `calm_floor`, in a picture that boils in places."""
    profit_beside_boiling: float = 2.0
    """As `calm_profit`, in a picture that boils in places."""
    calm_hold: float = 1.15
    """In a followed picture that boils in places, a vertex where it is calm goes only if one where
    it boils would cost this many times as much."""
    growth: Growth = TWICE
    """How the number of triangles develops in a first frame."""
    renewal: Growth = ANEW
    """How it develops where a followed picture boils."""

    def adapt(self, mesh: Mesh, appraiser: Appraiser, goal: Goal) -> Mesh:
        """Remove slivers, then flip, take vertices away and insert others, all measured once.

        Args:
            mesh: A valid mesh.
            appraiser: Measures it.
            goal: What to reach.

        Deviation: the paper keeps the Delaunay property and splits at centroids (Sec. 3.4).
        """
        appraiser.limit(goal.largest_area)
        mesh = divide_large(mesh, goal.largest_area)
        if goal.calm:
            thin = np.flatnonzero(mesh.heights < CALM_SLIVER_HEIGHT)
            mesh = press_slivers(mesh, appraiser.loose(mesh, thin), CALM_SLIVER_HEIGHT)
        else:
            mesh = collapse_slivers(mesh, SLIVER_HEIGHT, most_rounds=SLIVER_ROUNDS)
        if goal.unrest is not None:
            goal = replace(goal, unrest=goal.unrest.passed_on(mesh))
        free = np.ones(mesh.triangle_count, dtype=bool)
        slivers, turned = self._slivers(mesh, appraiser, goal, free)
        flips = self._flips(mesh, appraiser, goal)
        flips = flips[free[edge_triangles(mesh, flips)].all(axis=1)]
        flips = flips[independent_flips(mesh, flips)]
        if self._is_growing(mesh, goal) and len(flips):
            mesh, flips = flip_edges(mesh, flips), flips[:0]
        free[edge_triangles(mesh, flips)] = False
        missing = goal.count - mesh.triangle_count + _lost(mesh, slivers)
        splits, gains, points = self._splits(mesh, appraiser, goal, missing)
        floors = self._floors(mesh, appraiser, goal, splits)
        above = np.argsort(gains <= floors, kind="stable")  # where it boils, floors are lower
        splits, gains, points, floors = splits[above], gains[above], points[above], floors[above]
        going = self._collapses(mesh, appraiser, goal, free, gains, floors, missing)
        some = _affordable(mesh, splits, free, missing + _lost(mesh, going))
        going, flips = np.concatenate([slivers, going]), np.concatenate([turned, flips])
        # edits that do not touch each other leave each other's half-edges where they are
        mesh = flip_edges(mesh, flips) if len(flips) else mesh
        mesh = split_edges(mesh, splits[some], points[some]) if len(some) else mesh
        return collapse_edges(mesh, going) if len(going) else mesh

    def _slivers(
        self, mesh: Mesh, appraiser: Appraiser, goal: Goal, free: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Collapses and flips of slivers in a followed picture; `free` is updated."""
        if not goal.calm:
            nothing = np.empty(0, dtype=np.int64)
            return nothing, nothing
        appraiser.energies(mesh)
        return sliver_changes(mesh, appraiser, CALM_SLIVER_HEIGHT, goal.largest_area, free)

    def _flips(self, mesh: Mesh, appraiser: Appraiser, goal: Goal) -> np.ndarray:
        """Edges whose flip pays, best first."""
        if not goal.calm:
            return ranked_flips(mesh, appraiser, least_share=self.flip, floor=0.0)
        beside = None if goal.rest is None else goal.rest.unsettled(mesh)
        floor = self.calm_flip_floor * appraiser.energies(mesh).mean()
        calm = None if goal.unrest is None else goal.unrest.calm(mesh)
        return ranked_flips(mesh, appraiser, self.calm_flip, floor, calm, beside)

    def _splits(
        self, mesh: Mesh, appraiser: Appraiser, goal: Goal, missing: int
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Edges worth splitting, what each saves per new triangle, and the places; best first."""
        most = (max(0, missing) + 1) // 2 + self._relocations(mesh, goal)
        within = None
        if goal.unrest is not None and self._is_growing(mesh, goal):
            within = goal.unrest.boiling(mesh)
        if goal.rest is not None:
            within = goal.rest.unsettled(mesh)
        edges, gains, points = ranked_splits(mesh, appraiser, most, within)
        wanted = gains > LEAST_GAIN
        if goal.threshold is not None:
            floor = goal.threshold**2 * mesh.width * mesh.height
            bad = appraiser.energies(mesh) > floor
            wanted &= bad[edges // 3] | bad[np.maximum(mesh.twins[edges], 0) // 3]
        return edges[wanted], gains[wanted], points[wanted]

    def _floors(
        self, mesh: Mesh, appraiser: Appraiser, goal: Goal, edges: np.ndarray
    ) -> np.ndarray:
        """What splits of edges must save for a vertex to come from elsewhere, shape [N]."""
        if not goal.calm:
            return np.zeros(len(edges))
        floor = self.calm_floor if goal.unrest is None else self.floor_beside_boiling
        floors = np.full(len(edges), floor * appraiser.energies(mesh).mean())
        floors *= appraiser.emphasis(edges)
        if goal.unrest is not None:
            floors *= beside_edges(mesh, goal.unrest.calm(mesh), edges)
        return floors

    def _worth(self, mesh: Mesh, goal: Goal) -> np.ndarray | None:
        """How firmly vertices are held on to, beside those where it is calm, shape [V]."""
        if goal.unrest is None:
            return None
        return 1.0 - (1.0 - 1.0 / self.calm_hold) * goal.unrest.at(mesh)

    def _collapses(
        self,
        mesh: Mesh,
        appraiser: Appraiser,
        goal: Goal,
        free: np.ndarray,
        gains: np.ndarray,
        floors: np.ndarray,
        missing: int,
    ) -> np.ndarray:
        """Choose the vertices that are missed least, by half-edges out of them.

        What exceeds the count goes whatever it costs; beyond that those go that gain more
        elsewhere than they cost here.

        Args:
            mesh: The measured mesh.
            appraiser: Has measured it.
            goal: What to reach.
            free: Triangles that no change has claimed yet, [T] bool; updated.
            gains: What splits save per triangle, best first.
            floors: What each must save for a vertex to come from elsewhere.
            missing: Triangles below the count; below 0 where there are too many.
        """
        excess = max(0, (1 - missing) // 2)
        most = excess + min(self._relocations(mesh, goal), int((gains > floors).sum()))
        if most == 0:
            return np.empty(0, dtype=np.int64)
        going, costs = ranked_collapses(mesh, appraiser, most, self._worth(mesh, goal))
        apart = _away_from(mesh, going, free)
        going, costs = going[apart], costs[apart]
        apart = independent_collapses(mesh, going)
        going, costs = going[apart], costs[apart]
        # a vertex away pays for one split of an inner edge: two triangles
        pairs = max(0, min(len(going), most) - excess)
        pairs = min(pairs, len(gains))
        profit, floor = self.profit, np.zeros(pairs)
        if goal.calm:
            profit = self.calm_profit if goal.unrest is None else self.profit_beside_boiling
            floor = floors[:pairs]
        worth = np.maximum(profit * costs[excess : excess + pairs], floor)
        elsewhere = gains[:pairs] > worth
        going = going[: excess + int(elsewhere.sum())]
        _, corners = stars(mesh, mesh.triangles.reshape(-1)[going])
        free[corners // 3] = False
        return going

    def _is_growing(self, mesh: Mesh, goal: Goal) -> bool:
        """Whether so many splits are wanted that nothing else may be in their way."""
        return goal.count - mesh.triangle_count > GROWING * goal.count

    def _relocations(self, mesh: Mesh, goal: Goal) -> int:
        """Most vertices that may move elsewhere."""
        if self._is_growing(mesh, goal):
            return 0
        if not goal.calm:
            return int(self.relocated * goal.count)
        if goal.unrest is None:
            return int(self.calm_relocated * goal.count)
        more = self.relocated - self.beside_boiling
        boiling = int(goal.unrest.boiling(mesh).sum())
        return int(self.beside_boiling * goal.count + more * boiling)


def _lost(mesh: Mesh, collapses: np.ndarray) -> int:
    """Triangles that vanish with collapses of half-edges [N]."""
    return int(np.where(mesh.twins[collapses] >= 0, 2, 1).sum())


def _away_from(mesh: Mesh, half_edges: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Which collapses change none but free triangles, [N] bool."""
    places, corners = stars(mesh, mesh.triangles.reshape(-1)[half_edges])
    taken = np.bincount(places, weights=~free[corners // 3], minlength=len(half_edges))
    return taken == 0


def _affordable(mesh: Mesh, edges: np.ndarray, free: np.ndarray, missing: int) -> np.ndarray:
    """Places of the best edges that free triangles lie beside, until nothing is missing."""
    beside = edge_triangles(mesh, edges)
    possible = np.flatnonzero((free[beside] | (beside < 0)).all(axis=1))
    possible = possible[independent_flips(mesh, edges[possible])]
    added = np.cumsum(np.where(mesh.twins[edges[possible]] >= 0, 2, 1))
    return possible[: np.searchsorted(added, missing) + 1] if missing > 0 else possible[:0]
