"""Meshes that the tests start from."""

import numpy as np
from scipy.spatial import Delaunay

from stages.edits import flip_edges, flippable, independent_flips
from stages.mesh import Mesh, mesh_of

WIDTH, HEIGHT = 97, 64


def random_points(seed: int, inner: int, border: int = 12) -> np.ndarray:
    """Corners, random points on the border and random inner points [px], in general position."""
    rng = np.random.default_rng(seed)
    x, y = WIDTH * rng.random(border), HEIGHT * rng.random(border)
    side = rng.integers(4, size=border)
    x = np.where(side < 2, x, np.where(side == 2, 0, WIDTH))
    y = np.where(side >= 2, y, np.where(side == 0, 0, HEIGHT))
    corners = np.array([[0, 0], [WIDTH, 0], [0, HEIGHT], [WIDTH, HEIGHT]])
    return np.concatenate([corners, np.stack([x, y], 1), rng.random((inner, 2)) * (WIDTH, HEIGHT)])


def random_mesh(seed: int, inner: int = 60) -> Mesh:
    """A Delaunay mesh of random points."""
    points = random_points(seed, inner)
    return mesh_of(points, Delaunay(points).simplices, WIDTH, HEIGHT)


def scrambled(mesh: Mesh, seed: int, rounds: int = 5) -> Mesh:
    """The mesh after some rounds of random flips."""
    rng = np.random.default_rng(seed)
    for _ in range(rounds):
        edges = rng.permutation(mesh.edge_half_edges)
        edges = edges[flippable(mesh, edges, min_height=1e-3)]
        mesh = flip_edges(mesh, edges[independent_flips(mesh, edges)])
    return mesh


def triangle_set(triangles: np.ndarray) -> set[tuple[int, ...]]:
    """Triangles as a set, whatever their order and their first corners."""
    return {tuple(row) for row in np.sort(triangles, axis=1).tolist()}


def two_triangles() -> Mesh:
    """The smallest mesh: a square of 4 px cut from corner to corner."""
    return mesh_of(np.array([[0, 0], [4, 0], [4, 4], [0, 4]]), [[0, 1, 3], [1, 2, 3]], 4, 4)
