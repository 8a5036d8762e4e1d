"""Neighbours of one colour as areas, and the lines around these."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from stages.mesh import Mesh, next_corner


@dataclass(frozen=True, eq=False)
class Areas:
    """Areas of one or more triangles; one with holes has several lines around it."""

    shapes: np.ndarray
    """The area of each triangle, in the order of their first triangles, [T]."""
    loops: np.ndarray
    """Half-edges along borders, loop by loop and area by area, [N]."""
    counts: np.ndarray
    """Half-edges of each loop, [L]."""

    @property
    def loop_shapes(self) -> np.ndarray:
        """The area that each loop belongs to, [L]."""
        return np.asarray(self.shapes[self.loops[np.cumsum(self.counts) - self.counts] // 3])


def areas_of(mesh: Mesh, colors: np.ndarray) -> Areas:
    """Put neighbours of the same colour together.

    Args:
        mesh: The triangles.
        colors: Their colours, [T, 3] uint8.
    """
    shapes = _shapes(mesh, colors)
    twins, own = mesh.twins, np.repeat(shapes, 3)
    is_border = (twins < 0) | (own[twins] != own)
    return Areas(shapes, *_loops(mesh, is_border, own))


def _shapes(mesh: Mesh, colors: np.ndarray) -> np.ndarray:
    """A number for each triangle's shape, in the order of their first triangles, [T]."""
    values = colors.astype(np.int64) @ np.array([1 << 16, 1 << 8, 1])
    edges = mesh.edge_half_edges
    edges = edges[mesh.twins[edges] >= 0]
    one, other = edges // 3, mesh.twins[edges] // 3
    same = values[one] == values[other]
    count = mesh.triangle_count
    joins = (np.ones(same.sum(), dtype=bool), (one[same], other[same]))
    _, labels = connected_components(coo_array(joins, shape=(count, count)), directed=False)
    _, firsts, numbers = np.unique(labels, return_index=True, return_inverse=True)
    ranks = np.empty(len(firsts), np.int64)
    ranks[np.argsort(firsts)] = np.arange(len(firsts))
    return np.asarray(ranks[numbers])


def _loops(mesh: Mesh, is_border: np.ndarray, own: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Half-edges along borders, loop by loop and shape by shape, and the length of each loop.

    Args:
        mesh: The triangles.
        is_border: Which half-edges part two shapes, [3T] bool.
        own: The shape of each, [3T].
    """
    starts = np.flatnonzero(is_border)
    following = next_corner(starts)
    while True:  # on around the vertex, through the shape, up to its next border
        inside = ~is_border[following]
        if not inside.any():
            break
        following[inside] = next_corner(mesh.twins[following[inside]])
    ahead = dict(zip(starts.tolist(), following.tolist(), strict=True))
    starts = starts[np.argsort(own[starts], kind="stable")].tolist()
    seen = (~is_border).tolist()
    loops: list[int] = []
    counts: list[int] = []
    for start in starts:
        place, before = start, len(loops)
        while not seen[place]:
            seen[place] = True
            loops.append(place)
            place = ahead[place]
        if len(loops) > before:
            counts.append(len(loops) - before)
    return np.array(loops), np.array(counts)
