"""What of a mesh a person holds fast: the optimiser leaves it, and only the motion moves it."""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from stages.mesh import Mesh, next_corner

_NO_IDS = np.empty(0, dtype=np.int64)
_NO_PAIRS = np.empty((0, 2), dtype=np.int64)


def _no_ids() -> np.ndarray:
    return _NO_IDS


def _no_pairs() -> np.ndarray:
    return _NO_PAIRS


@dataclass(frozen=True, eq=False)
class Held:
    """Locks as masks over one mesh."""

    vertices: np.ndarray
    """Vertices that nothing but the motion of the picture moves, [V] bool."""
    kept: np.ndarray
    """Vertices that must not vanish: those and the corners beside held edges, [V] bool."""
    edges: np.ndarray
    """Half-edges that must not be flipped, in both directions, [3T] bool."""
    undivided: np.ndarray
    """Half-edges that must not be split, in both directions, [3T] bool."""


@dataclass(frozen=True, eq=False)
class Locks:
    """Persistent ids of what is held fast; what they name may be gone by now, see `within`."""

    vertices: np.ndarray = field(default_factory=_no_ids)
    """Vertices that neither vanish nor move but by the motion of the picture; ids, ascending [N]
    int64."""
    edges: np.ndarray = field(default_factory=_no_pairs)
    """Edges that are not flipped; ids of their ends, the lower first, ascending [M, 2] int64."""
    bare: np.ndarray = field(default_factory=_no_ids)
    """Triangles that get no vertex, for a person took one away there; ids, ascending [K] int64."""

    @cached_property
    def is_empty(self) -> bool:
        """Whether nothing is held."""
        return not (len(self.vertices) or len(self.edges) or len(self.bare))

    def adding(
        self,
        vertices: np.ndarray = _NO_IDS,
        edges: np.ndarray = _NO_PAIRS,
        bare: np.ndarray = _NO_IDS,
    ) -> "Locks":
        """These and others.

        Args:
            vertices: Ids, shape [N].
            edges: Ids of the ends, in any order, shape [M, 2].
            bare: Ids of triangles, shape [K].
        """
        pairs = np.sort(np.asarray(edges, dtype=np.int64).reshape(-1, 2), axis=1)
        return Locks(
            np.union1d(self.vertices, vertices).astype(np.int64),
            np.unique(np.concatenate([self.edges, pairs]), axis=0),
            np.union1d(self.bare, bare).astype(np.int64),
        )

    def without(
        self,
        vertices: np.ndarray = _NO_IDS,
        edges: np.ndarray = _NO_PAIRS,
        bare: np.ndarray = _NO_IDS,
    ) -> "Locks":
        """These but for some, named as in `adding`."""
        pairs = np.sort(np.asarray(edges, dtype=np.int64).reshape(-1, 2), axis=1)
        going = (self.edges[:, None] == pairs[None]).all(axis=2).any(axis=1)
        return Locks(
            self.vertices[~np.isin(self.vertices, vertices)],
            self.edges[~going],
            self.bare[~np.isin(self.bare, bare)],
        )

    def joined(self, other: "Locks") -> "Locks":
        """These and those of another mesh of the shot."""
        return self.adding(other.vertices, other.edges, other.bare)

    def but_for(self, other: "Locks") -> "Locks":
        """These but for others."""
        return self.without(other.vertices, other.edges, other.bare)

    def within(self, mesh: Mesh) -> "Locks":
        """Those of them that the mesh still has.

        Args:
            mesh: The mesh.
        """
        if self.is_empty:
            return self
        edges = self.edges
        if len(edges):
            known = _edge_keys(mesh, mesh.vertex_ids[mesh.edge_vertices])
            edges = edges[np.isin(_edge_keys(mesh, edges), known)]
        return replace(
            self,
            vertices=self.vertices[np.isin(self.vertices, mesh.vertex_ids)],
            edges=edges,
            bare=self.bare[np.isin(self.bare, mesh.triangle_ids)],
        )

    def held(self, mesh: Mesh) -> Held:
        """Masks over a mesh.

        Args:
            mesh: The mesh, or what has become of it.
        """
        vertices = np.isin(mesh.vertex_ids, self.vertices)
        half_edges = np.arange(3 * mesh.triangle_count)
        corners = mesh.triangles.reshape(-1)
        ends = mesh.vertex_ids[np.stack([corners, corners[next_corner(half_edges)]], axis=1)]
        edges = np.isin(_edge_keys(mesh, ends), _edge_keys(mesh, self.edges))
        kept = vertices.copy()
        kept[mesh.triangles[edges.reshape(-1, 3).any(axis=1)]] = True
        bare = np.repeat(np.isin(mesh.triangle_ids, self.bare), 3)
        beyond = (mesh.twins >= 0) & bare[mesh.twins]
        return Held(vertices, kept, edges, bare | beyond | edges)

    def extra(self, mesh: Mesh) -> int:
        """Triangles that a mesh has beyond its budget: two for each held vertex inside, one for
        each on the border.

        Args:
            mesh: The mesh.
        """
        held = np.isin(mesh.vertex_ids, self.vertices)
        sides = mesh.on_left_right.astype(np.int64) + mesh.on_top_bottom
        return int((2 - sides[held]).sum())


NO_LOCKS = Locks()
"""Nothing is held."""


def _edge_keys(mesh: Mesh, ends: np.ndarray) -> np.ndarray:
    """One number for each pair of ids, in any order, shape [N]; unknown ids may be large."""
    pairs = np.sort(np.asarray(ends, dtype=np.int64).reshape(-1, 2), axis=1)
    return pairs[:, 0] * (mesh.next_vertex_id + 1) + np.minimum(pairs[:, 1], mesh.next_vertex_id)
