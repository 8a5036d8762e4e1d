"""Two meshes of one picture, and meshes between them that have a part of each.

Both come from the same mesh, by different ways, so most triangles are in both. What differs are
islands: sets of triangles between edges that are in both meshes. Each can be taken from one or from
the other, and so one mesh becomes the other little by little.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from stages.hand.locks import Locks
from stages.mesh import Mesh, areas_of, centres_of, heights_of, next_corner
from stages.motion.correspondence import kept_rows, kept_triangles

LOWEST = 0.05
"""No triangle between two meshes becomes lower than this [px], or than it is in its own."""
ROUNDS = 4
"""Rings of vertices around what is held that may be pushed out of its way."""


@dataclass(frozen=True, eq=False)
class Meeting:
    """Two meshes of one shot and of the same frame."""

    one: Mesh
    """The mesh that goes."""
    other: Mesh
    """The mesh that comes."""

    @cached_property
    def _apart(self) -> tuple[np.ndarray, np.ndarray]:
        """Which triangles of each mesh the other lacks, [T] bool."""
        apart = kept_triangles(self.other, self.one) < 0, kept_triangles(self.one, self.other) < 0
        for mesh, some, shared in zip((self.one, self.other), apart, self._pairs, strict=True):
            lone = np.ones(mesh.vertex_count, dtype=bool)
            lone[shared] = False
            some |= lone[mesh.triangles].any(axis=1)
        return apart

    @cached_property
    def _islands(self) -> tuple[np.ndarray, np.ndarray, int]:
        """The island of each triangle of both meshes, -1 for those that they share, and how many
        islands there are."""
        from scipy.sparse import coo_array  # takes a second to import, and few jobs come here
        from scipy.sparse.csgraph import connected_components

        pair = self.one, self.other
        apart = self._apart
        sides = _common_sides(pair, apart, self._pairs)
        parts = zip(pair, apart, sides, strict=True)
        links = [_neighbours(mesh, own, common) for mesh, own, common in parts]
        shift = self.one.triangle_count
        outline = np.stack([sides[0] // 3, sides[1] // 3 + shift], axis=1)
        links[1] += shift
        begins, ends = np.concatenate([*links, outline]).T
        count = shift + self.other.triangle_count
        graph = coo_array((np.ones(len(begins)), (begins, ends)), shape=(count, count))
        _, labels = connected_components(graph, directed=False)
        apart_all = np.concatenate(apart)
        numbers = np.full(count, -1)
        found, numbers[apart_all] = np.unique(labels[apart_all], return_inverse=True)
        return numbers[:shift], numbers[shift:], len(found)

    def spread(self) -> tuple[np.ndarray, np.ndarray]:
        """Where the islands are, from left to right [px], and how large [px^2]; each [K]."""
        mine, _, count = self._islands
        inside = mine >= 0
        areas = np.bincount(mine[inside], self.one.areas[inside], count)
        x = centres_of(self.one.corners)[inside, 0] * self.one.areas[inside]
        return np.bincount(mine[inside], x, count) / np.maximum(areas, 1e-9), areas

    def between(self, share: float, line: float) -> Mesh | None:
        """A mesh on the way from one to the other.

        Args:
            share: How far the vertices that both have are on their way, 0 to 1.
            line: Islands left of this are those of the other mesh [px].

        Returns:
            A valid mesh, or None if there is none such.
        """
        return self._mixed(np.full(len(self._pairs[0]), share), self.spread()[0] < line)

    def only(self, locks: Locks) -> Mesh | None:
        """The first mesh, but for what is held fast of the other one.

        Args:
            locks: What is held of the other mesh.

        Returns:
            A valid mesh, or None if there is none such.
        """
        other = self.other
        corners = np.isin(other.vertex_ids, locks.vertices)
        touched = corners[other.triangles].any(axis=1) | np.isin(other.triangle_ids, locks.bare)
        touched |= locks.held(other).edges.reshape(-1, 3).any(axis=1)
        theirs = self._islands[1]
        inside = touched & (theirs >= 0)
        comes = np.bincount(theirs[inside], minlength=self._islands[2]) > 0
        shares = corners[self._pairs[1]].astype(np.float64)
        for _ in range(ROUNDS):
            mesh = self._mixed(shares, comes)
            if mesh is not None:
                return mesh
            # what is held pushes those around it out of the way, as it does in the other mesh
            folded = _folded(other, self._placed(shares)[1])
            near = np.zeros(other.vertex_count, dtype=bool)
            near[other.triangles[folded]] = True
            shares = np.where(near[self._pairs[1]], 1.0, shares)
        return None

    def _mixed(self, shares: np.ndarray, comes: np.ndarray) -> Mesh | None:
        """A mesh of both.

        Args:
            shares: How far each common vertex is on its way from one to the other, [N].
            comes: Islands that are those of the other mesh, if that folds nothing, [K] bool.

        Returns:
            A valid mesh, or None if there is none such.
        """
        places = self._placed(shares)
        islands, count = self._islands[:2], self._islands[2]
        bad = _folded(self.one, places[0]), _folded(self.other, places[1])
        broken = [
            np.bincount(mine[folds & (mine >= 0)], minlength=count) > 0
            for mine, folds in zip(islands, bad, strict=True)
        ]
        if bad[1][islands[1] < 0].any() or (broken[0] & broken[1]).any():
            return None
        comes = (comes & ~broken[1]) | broken[0]
        stays = np.append(~comes, False)[islands[0]]
        return self._joined(places, stays, np.append(comes, True)[islands[1]])

    @cached_property
    def _pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """Numbers in both meshes of the vertices that both have, each [N]; not of one that came to
        the border, or left it."""
        rows = kept_rows(self.other.vertex_ids, self.one.vertex_ids)
        mine = np.flatnonzero(rows >= 0)
        theirs = rows[mine]
        alike = self.one.on_left_right[mine] == self.other.on_left_right[theirs]
        alike &= self.one.on_top_bottom[mine] == self.other.on_top_bottom[theirs]
        return mine[alike], theirs[alike]

    def _placed(self, shares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Vertices of both meshes, those that both have in the same places, each [V, 2]."""
        mine, theirs = self._pairs
        begin, end = self.one.vertices[mine], self.other.vertices[theirs]
        vertices = self.one.vertices.copy(), self.other.vertices.copy()
        vertices[0][mine] = vertices[1][theirs] = begin + shares[:, None] * (end - begin)
        return vertices

    def _joined(
        self, places: tuple[np.ndarray, np.ndarray], stays: np.ndarray, new: np.ndarray
    ) -> Mesh:
        """The triangles of one that stay and those of the other that come."""
        one, other = self.one, self.other
        corner_ids = np.concatenate(
            [one.vertex_ids[one.triangles[stays]], other.vertex_ids[other.triangles[new]]]
        )
        triangle_ids = np.concatenate([one.triangle_ids[stays], other.triangle_ids[new]])
        following = max(one.next_triangle_id, other.next_triangle_id)
        _, first = np.unique(triangle_ids, return_index=True)
        twice = np.ones(len(triangle_ids), dtype=bool)
        twice[first] = False
        triangle_ids[twice] = following + np.arange(twice.sum())
        used = np.unique(one.triangles[stays]), np.unique(other.triangles[new])
        ids = np.concatenate([one.vertex_ids[used[0]], other.vertex_ids[used[1]]])
        vertices = np.concatenate([places[0][used[0]], places[1][used[1]]])
        ids, first = np.unique(ids, return_index=True)
        order = np.argsort(triangle_ids)
        return replace(
            one,
            vertices=vertices[first],
            triangles=np.searchsorted(ids, corner_ids[order]),
            vertex_ids=ids,
            triangle_ids=triangle_ids[order],
            next_vertex_id=max(one.next_vertex_id, other.next_vertex_id),
            next_triangle_id=following + int(twice.sum()),
        )


def _folded(mesh: Mesh, vertices: np.ndarray) -> np.ndarray:
    """Triangles that are too low over other positions, [T] bool."""
    corners = vertices[mesh.triangles]
    least = np.minimum(LOWEST, 0.5 * mesh.heights)
    return (areas_of(corners) <= 0) | (heights_of(corners) < least)


def _neighbours(mesh: Mesh, some: np.ndarray, common: np.ndarray) -> np.ndarray:
    """Pairs of some triangles that meet at an edge which only their mesh has, [N, 2].

    Args:
        mesh: The mesh.
        some: Which triangles, [T] bool.
        common: Half-edges that the other mesh has as well, in this direction, [M].
    """
    parts = np.zeros(3 * mesh.triangle_count, dtype=bool)
    parts[common] = True
    half_edges = np.flatnonzero((mesh.twins >= 0) & ~(parts & parts[mesh.twins]))
    pairs = np.stack([half_edges // 3, mesh.twins[half_edges] // 3], axis=1).astype(np.int64)
    inner: np.ndarray = pairs[some[pairs].all(axis=1)]
    return inner


def _common_sides(
    meshes: tuple[Mesh, Mesh],
    apart: tuple[np.ndarray, np.ndarray],
    common: tuple[np.ndarray, np.ndarray],
) -> tuple[np.ndarray, np.ndarray]:
    """Half-edges of triangles that two meshes do not share, which are the same by their ends.

    Args:
        meshes: Two of the same shot.
        apart: Which triangles of each mesh the other lacks, [T] bool.
        common: Vertices of each mesh that both have, [N].

    Returns:
        Their numbers in both meshes, each [M].
    """
    following = max(mesh.next_vertex_id for mesh in meshes)
    found = []
    for mesh, some, both in zip(meshes, apart, common, strict=True):
        half_edges = np.flatnonzero(np.repeat(some, 3))
        corners = mesh.triangles.reshape(-1)
        ends = np.stack([corners[half_edges], corners[next_corner(half_edges)]], axis=1)
        shared = np.zeros(mesh.vertex_count, dtype=bool)
        shared[both] = True
        kept = shared[ends].all(axis=1)
        ids = mesh.vertex_ids[ends[kept]]
        found.append((ids[:, 0] * following + ids[:, 1], half_edges[kept]))
    _, mine, theirs = np.intersect1d(found[0][0], found[1][0], return_indices=True)
    return found[0][1][mine], found[1][1][theirs]
