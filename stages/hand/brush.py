"""Where the bristles of a round brush touch the picture, and vertices that they put there."""

from collections.abc import Iterator

import numpy as np

from stages.edits import legalise, split_triangles
from stages.hand.find import Point, triangles_at
from stages.hand.worked import Worked
from stages.mesh import Mesh, heights_of
from warp_kernels.errors import EditError

SPREADS = ("uniform", "normal")
"""How bristles are spread: evenly over the disc, or most in its middle."""
MOST = 10_000
"""Most vertices of one stroke."""
LOWEST = 0.5
"""No stroke leaves a triangle below this height [px]: one further is tried instead."""
MISSES = 300
"""Points that fit nowhere one after the other, after which the mesh is held to be dense."""


def check_brush(radius: float, count: int, spread: str, seed: int) -> None:
    """Refuse brushes that there are not.

    Raises:
        EditError: Naming the first parameter that is impossible.
    """
    check_radius(radius)
    check_count(count, seed)
    if spread not in SPREADS:
        raise EditError(f"spread {spread!r}: choose from {', '.join(SPREADS)}")


def check_radius(radius: float) -> None:
    """Refuse brushes without a size.

    Raises:
        EditError: If there is none such.
    """
    if not 0 < radius < 1e5:
        raise EditError(f"radius {radius:g}: must be above 0 px; give one such as 20")


def check_count(count: int, seed: int) -> None:
    """Refuse numbers of vertices that there are not.

    Raises:
        EditError: If one is impossible.
    """
    if not 1 <= count <= MOST:
        raise EditError(f"count {count}: must be from 1 to {MOST}; give one such as 20")
    if seed < 0:
        raise EditError(f"seed {seed}: must be 0 or more")


def strokes(at: Point, radius: float, spread: str, rng: np.random.Generator) -> Iterator[Point]:
    """Points that a brush touches, without an end.

    Args:
        at: Its centre [px].
        radius: Its radius [px]; of a normal spread twice the standard deviation.
        spread: One of `SPREADS`.
        rng: Source of the draws.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5: brushes of uniform
        and of normal distribution.
    """
    while True:
        angle, share = 2.0 * np.pi * rng.random(), rng.random()
        if spread == "uniform":
            away = radius * np.sqrt(share)
        else:  # a disc of two standard deviations holds 86 % of a normal one; the rest is drawn in
            away = 0.5 * radius * np.sqrt(-2.0 * np.log1p(-share * (1.0 - np.exp(-2.0))))
        yield at[0] + away * np.cos(angle), at[1] + away * np.sin(angle)


def with_points(worked: Worked, points: Iterator[Point], count: int, *, lock: bool) -> Worked:
    """Insert vertices, and make the triangles around them Delaunay.

    Args:
        worked: The mesh.
        points: Where vertices may come to be, more than are wanted [px].
        count: How many shall come.
        lock: Whether they are held.

    Raises:
        EditError: If not one fits.
    """
    mesh, split = worked.mesh, []
    misses = 0
    while count > 0 and misses < MISSES:
        misses += 1
        point = next(points)
        if not (0 < point[0] < mesh.width and 0 < point[1] < mesh.height):
            continue
        place = np.array([point])
        triangle = triangles_at(mesh, place)
        corners = mesh.corners[triangle][0]
        parts = np.stack([np.stack([corners[i], corners[(i + 1) % 3], place[0]]) for i in range(3)])
        if heights_of(parts).min() < LOWEST:
            continue
        split.append(mesh.triangle_ids[triangle])
        mesh = split_triangles(mesh, triangle, place)
        count, misses = count - 1, 0
    fresh = worked.fresh_vertices(mesh)
    if not len(fresh):
        raise EditError(
            f"not one vertex fits between those at ({point[0]:g}, {point[1]:g}); use a larger brush"
        )
    mesh = _settled(worked, mesh)
    locks = worked.locks.without(bare=np.concatenate(split))
    return worked.became(mesh, locks.adding(vertices=fresh) if lock else locks)


def _settled(worked: Worked, mesh: Mesh) -> Mesh:
    """Delaunay triangles around new vertices, unless a held edge would be lost by it."""
    is_new = mesh.vertex_ids >= worked.mesh.next_vertex_id
    settled = legalise(mesh, is_new[mesh.triangles].any(axis=1))
    held = worked.locks.within(mesh).edges
    return settled if len(worked.locks.within(settled).edges) == len(held) else mesh
