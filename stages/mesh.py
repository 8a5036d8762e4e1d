"""The triangulation of one frame: immutable arrays and the tables that follow from them."""

from dataclasses import dataclass, replace
from functools import cached_property, reduce

import numpy as np

_TOPOLOGY = (
    "twins",
    "edge_half_edges",
    "half_edge_to_edge",
    "half_edge_reversed",
    "edge_vertices",
    "_fans",
)
"""The cached tables that depend on `triangles` alone: a moved mesh keeps them."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles that cover the domain [0, width] x [0, height] once, x right and y down.

    Row order is meaning: corner 0 of a triangle starts its base edge. Ids persist from frame
    to frame; what an edit changes goes on under its own, what it adds gets the next fresh ones.
    Arrays are read-only: those handed in writable are copied. `stages.validate.assert_valid` states
    what a mesh must obey.

    Half-edge e = 3 t + c is corner c of triangle t, the edge from that corner to the next one,
    and the place of the neighbour across that edge, all at once.
    """

    width: int
    """Width of the domain [px]."""
    height: int
    """Height of the domain [px]."""
    vertices: np.ndarray
    """Positions [px], shape [V, 2] float64."""
    triangles: np.ndarray
    """Vertex numbers of the corners, shape [T, 3] int32; positive signed area."""
    vertex_ids: np.ndarray
    """Persistent number of each vertex, shape [V] int64."""
    triangle_ids: np.ndarray
    """Persistent number of each triangle, shape [T] int64."""
    next_vertex_id: int
    """The next fresh vertex number: above every number given so far."""
    next_triangle_id: int
    """The next fresh triangle number: above every number given so far."""

    def __post_init__(self) -> None:
        for name, dtype in (
            ("vertices", np.float64),
            ("triangles", np.int32),
            ("vertex_ids", np.int64),
            ("triangle_ids", np.int64),
        ):
            array = np.ascontiguousarray(getattr(self, name), dtype=dtype)
            own = array.copy() if array.flags.writeable else array
            object.__setattr__(self, name, _read_only(own))

    def __repr__(self) -> str:
        return (
            f"Mesh({self.width}x{self.height}, {self.vertex_count} vertices, "
            f"{self.triangle_count} triangles)"
        )

    @property
    def vertex_count(self) -> int:
        """Number of vertices V."""
        return len(self.vertices)

    @property
    def triangle_count(self) -> int:
        """Number of triangles T."""
        return len(self.triangles)

    @property
    def edge_count(self) -> int:
        """Number of undirected edges E."""
        return len(self.edge_half_edges)

    def moved(self, vertices: np.ndarray) -> "Mesh":
        """The same triangles over other positions.

        Args:
            vertices: New positions [px], shape [V, 2].
        """
        mesh = replace(self, vertices=vertices)
        for name in _TOPOLOGY:
            if name in self.__dict__:
                mesh.__dict__[name] = self.__dict__[name]
        return mesh

    def with_twins(self, twins: np.ndarray) -> "Mesh":
        """Hand over a twin table that an edit kept up to date, to save its computation.

        Args:
            twins: What `twins` would compute, shape [3T] int32.
        """
        self.__dict__["twins"] = _read_only(twins)
        return self

    @cached_property
    def twins(self) -> np.ndarray:
        """The half-edge that runs the other way, -1 on the border; shape [3T] int32."""
        return _read_only(twins_of(self.triangles, self.vertex_count))

    @cached_property
    def edge_half_edges(self) -> np.ndarray:
        """The half-edge that represents each edge (the lower of two), shape [E] int32."""
        return _read_only(np.flatnonzero(~self.half_edge_reversed).astype(np.int32))

    @cached_property
    def edge_vertices(self) -> np.ndarray:
        """Origin and destination of each edge's representative, shape [E, 2] int32."""
        origins = self.edge_half_edges
        ends = np.stack([origins, next_corner(origins)], axis=1)
        return _read_only(self.triangles.reshape(-1)[ends])

    @cached_property
    def half_edge_to_edge(self) -> np.ndarray:
        """The edge of each half-edge, shape [3T] int32."""
        numbers = np.cumsum(~self.half_edge_reversed, dtype=np.int32) - np.int32(1)
        own = np.arange(len(self.twins), dtype=np.int32)
        return _read_only(numbers[np.where(self.half_edge_reversed, self.twins, own)])

    @cached_property
    def half_edge_reversed(self) -> np.ndarray:
        """Whether a half-edge runs against its edge's representative, shape [3T] bool."""
        return _read_only(
            (self.twins >= 0) & (self.twins < np.arange(len(self.twins), dtype=np.int32))
        )

    @property
    def fan_offsets(self) -> np.ndarray:
        """Where the corners of each vertex start in `fan_corners`, shape [V + 1] int32."""
        return self._fans[0]

    @property
    def fan_corners(self) -> np.ndarray:
        """The corners (half-edge numbers) at each vertex, ascending, shape [3T] int32."""
        return self._fans[1]

    @cached_property
    def _fans(self) -> tuple[np.ndarray, np.ndarray]:
        offsets, corners = fans_of(self.triangles, self.vertex_count)
        return _read_only(offsets), _read_only(corners)

    @property
    def corners(self) -> np.ndarray:
        """Positions of each triangle's corners [px], shape [T, 3, 2]."""
        # ten times as fast as `vertices[triangles]`
        return self.vertices.take(self.triangles, axis=0)

    @cached_property
    def corner_columns(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions of the corners [px] as x and y, each of shape [3, T]: long rows add faster."""
        rows = np.ascontiguousarray(self.triangles.T)
        x, y = np.ascontiguousarray(self.vertices.T)
        return _read_only(x.take(rows)), _read_only(y.take(rows))

    @cached_property
    def areas(self) -> np.ndarray:
        """Signed area of each triangle [px^2], shape [T]."""
        return _read_only(_areas(*self.corner_columns))

    @cached_property
    def heights(self) -> np.ndarray:
        """Smallest height of each triangle [px], shape [T]; signed like the area."""
        return _read_only(heights_of(self.corners))

    @cached_property
    def on_left_right(self) -> np.ndarray:
        """Vertices on the left or right border: their x may not change; shape [V] bool."""
        x = self.vertices[:, 0]
        return _read_only((x == 0) | (x == self.width))

    @cached_property
    def on_top_bottom(self) -> np.ndarray:
        """Vertices on the upper or lower border: their y may not change; shape [V] bool."""
        y = self.vertices[:, 1]
        return _read_only((y == 0) | (y == self.height))


def mesh_of(points: np.ndarray, triangles: np.ndarray, width: int, height: int) -> Mesh:
    """A new mesh: rows turned to positive area, ids counted from 0.

    Args:
        points: Positions [px], shape [V, 2].
        triangles: Vertex numbers, shape [T, 3]; rows of negative area swap their last corners.
        width: Width of the domain [px].
        height: Height of the domain [px].
    """
    rows = np.array(triangles, dtype=np.int32)
    swapped = areas_of(np.asarray(points, dtype=np.float64)[rows]) < 0
    rows[swapped] = rows[swapped][:, [0, 2, 1]]
    return Mesh(
        width=width,
        height=height,
        vertices=points,
        triangles=rows,
        vertex_ids=np.arange(len(points)),
        triangle_ids=np.arange(len(rows)),
        next_vertex_id=len(points),
        next_triangle_id=len(rows),
    )


def next_corner(half_edges: np.ndarray) -> np.ndarray:
    """The half-edge after each one in its triangle, shape [N]."""
    return half_edges + np.where(half_edges % 3 == 2, -2, 1).astype(half_edges.dtype)


def previous_corner(half_edges: np.ndarray) -> np.ndarray:
    """The half-edge before each one in its triangle, shape [N]."""
    return half_edges + np.where(half_edges % 3 == 0, 2, -1).astype(half_edges.dtype)


def areas_of(corners: np.ndarray) -> np.ndarray:
    """Signed areas, positive where the corners turn clockwise on the screen (y down).

    Args:
        corners: Positions [px], shape [N, 3, 2].

    Returns:
        Areas [px^2], shape [N].
    """
    return _areas(*_columns(corners))


def _areas(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.5 * ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]))


def heights_of(corners: np.ndarray) -> np.ndarray:
    """Smallest heights: twice the signed area over the longest edge, 0 for a single point.

    Args:
        corners: Positions [px], shape [N, 3, 2].

    Returns:
        Heights [px], shape [N], signed like the area.
    """
    x, y = _columns(corners)
    squares = ((x[i] - x[j]) ** 2 + (y[i] - y[j]) ** 2 for i, j in ((0, 1), (1, 2), (2, 0)))
    longest = np.sqrt(reduce(np.maximum, squares))
    # Where the longest edge is 0 the area is 0 as well, so any positive divisor gives 0.
    return 2.0 * areas_of(corners) / np.where(longest > 0, longest, 1.0)


def centres_of(corners: np.ndarray) -> np.ndarray:
    """Centroids.

    Args:
        corners: Positions [px], shape [N, 3, 2].

    Returns:
        Positions [px], shape [N, 2].
    """
    return np.stack([(a + b + c) / 3 for a, b, c in _columns(corners)], axis=1)


def _columns(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners [N, 3, 2] as x and y, each [3, N]: long rows add faster than short ones."""
    x, y = np.ascontiguousarray(corners.reshape(-1, 6).T).reshape(3, 2, -1).swapaxes(0, 1)
    return x, y


def twins_of(triangles: np.ndarray, vertex_count: int) -> np.ndarray:
    """Pair the two half-edges of every edge.

    Args:
        triangles: Vertex numbers, shape [T, 3]; no edge in more than two triangles.
        vertex_count: Number of vertices V.

    Returns:
        The other half-edge of the same edge, -1 on the border; shape [3T] int32.
    """
    tails = triangles.reshape(-1).astype(np.int64)
    heads = triangles[:, [1, 2, 0]].reshape(-1).astype(np.int64)
    edges = np.minimum(tails, heads) * vertex_count + np.maximum(tails, heads)
    order, edges = _sorted_with_order(edges, vertex_count * vertex_count)
    first = np.flatnonzero(edges[1:] == edges[:-1])
    twins = np.full(len(tails), -1, dtype=np.int32)
    twins[order[first]] = order[first + 1]
    twins[order[first + 1]] = order[first]
    return twins


def fans_of(triangles: np.ndarray, vertex_count: int) -> tuple[np.ndarray, np.ndarray]:
    """List the corners at every vertex.

    Args:
        triangles: Vertex numbers, shape [T, 3].
        vertex_count: Number of vertices V.

    Returns:
        Offsets [V + 1] int32 and corners (half-edge numbers) [3T] int32, ascending per vertex.
    """
    owners = triangles.reshape(-1).astype(np.int64)
    order, _ = _sorted_with_order(owners, vertex_count)
    offsets = np.zeros(vertex_count + 1, dtype=np.int32)
    np.cumsum(np.bincount(owners, minlength=vertex_count), out=offsets[1:])
    return offsets, order.astype(np.int32)


def _sorted_with_order(keys: np.ndarray, limit: int) -> tuple[np.ndarray, np.ndarray]:
    """Stable order of non-negative `keys` below `limit`, and the keys in that order.

    A plain sort of (key, position) packed into one int64 is several times as fast as an
    argsort; meshes too large to be packed (beyond a million vertices) take the argsort.
    """
    shift = len(keys).bit_length()
    if limit.bit_length() + shift > 63:
        order = np.argsort(keys, kind="stable")
        return order, keys[order]
    packed = np.sort((keys << shift) | np.arange(len(keys)))
    return packed & ((1 << shift) - 1), packed >> shift


def _read_only(array: np.ndarray) -> np.ndarray:
    array.setflags(write=False)
    return array
