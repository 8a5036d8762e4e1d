"""What of a mesh a person points at."""

import numpy as np

from stages.mesh import Mesh, next_corner
from warp_kernels.errors import EditError

Point = tuple[float, float]
"""A position in the picture [px], x right and y down."""
FURTHEST = 1e6
"""No corner of a region lies further away [px]."""


def check_inside(mesh: Mesh, at: Point) -> np.ndarray:
    """The point as an array [2].

    Raises:
        EditError: If it lies outside of the picture.
    """
    if not (0 <= at[0] <= mesh.width and 0 <= at[1] <= mesh.height):
        raise EditError(
            f"({at[0]:g}, {at[1]:g}) lies outside of the picture of {mesh.width}x{mesh.height}; "
            "give a place inside"
        )
    return np.array(at, dtype=np.float64)


def nearest_vertex(mesh: Mesh, at: Point) -> int:
    """Number of the vertex that is nearest to a point.

    Raises:
        EditError: If the point lies outside of the picture.
    """
    offsets = mesh.vertices - check_inside(mesh, at)
    return int((offsets**2).sum(axis=1).argmin())


def nearest_edge(mesh: Mesh, at: Point) -> tuple[int, np.ndarray]:
    """The edge that is nearest to a point, by its half-edge, and the place on it [2].

    Raises:
        EditError: If the point lies outside of the picture.
    """
    point = check_inside(mesh, at)
    ends = mesh.vertices[mesh.edge_vertices]
    along = ends[:, 1] - ends[:, 0]
    share = ((point - ends[:, 0]) * along).sum(axis=1) / (along**2).sum(axis=1)
    places = ends[:, 0] + np.clip(share, 0.0, 1.0)[:, None] * along
    edge = int(((places - point) ** 2).sum(axis=1).argmin())
    return int(mesh.edge_half_edges[edge]), places[edge]


def triangle_at(mesh: Mesh, at: Point) -> int:
    """Number of the triangle that a point lies in.

    Raises:
        EditError: If the point lies outside of the picture.
    """
    return int(triangles_at(mesh, check_inside(mesh, at)[None])[0])


def triangles_at(mesh: Mesh, points: np.ndarray) -> np.ndarray:
    """Numbers of the triangles that points inside of the picture lie in, [N].

    Args:
        mesh: A valid mesh.
        points: Positions [px], shape [N, 2].
    """
    corners, areas = mesh.corners, mesh.areas
    sides = corners[:, (1, 2, 0)] - corners
    found = np.empty(len(points), dtype=np.int64)
    for number, point in enumerate(points):
        away = point - corners
        parts = sides[..., 0] * away[..., 1] - sides[..., 1] * away[..., 0]
        # how far inside, as a share of the triangle: rounding leaves no point between two of them
        found[number] = (parts.min(axis=1) / areas).argmax()
    return found


def inside_polygon(points: np.ndarray, polygon: tuple[Point, ...]) -> np.ndarray:
    """Whether points lie in a polygon, which may have any shape; shape [N] bool.

    Args:
        points: Positions [px], shape [N, 2].
        polygon: Its corners [px].
    """
    x, y = points.T
    inside = np.zeros(len(points), dtype=bool)
    for (x0, y0), (x1, y1) in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        crosses = (y0 > y) != (y1 > y)
        if y0 != y1:
            inside ^= crosses & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return inside


def check_polygon(mesh: Mesh, polygon: tuple[Point, ...]) -> None:
    """Refuse what is no region of the picture.

    Raises:
        EditError: If there are fewer than three corners, or none of them is a place.
    """
    if len(polygon) < 3:
        raise EditError(f"a polygon of {len(polygon)} corners has no inside; give three or more")
    if np.abs(polygon).max() > FURTHEST:
        raise EditError(
            f"a polygon with a corner further than {FURTHEST:g} px from the picture; draw it closer"
        )
    right, down = np.max(polygon, axis=0)
    left, up = np.min(polygon, axis=0)
    if right < 0 or down < 0 or left > mesh.width or up > mesh.height:
        raise EditError(
            f"the polygon from ({left:g}, {up:g}) to ({right:g}, {down:g}) lies outside of the "
            f"picture of {mesh.width}x{mesh.height}; give one inside"
        )


def ends_of(mesh: Mesh, half_edge: int) -> np.ndarray:
    """Ids of the ends of an edge, [2]."""
    corners = mesh.triangles.reshape(-1)
    ends = np.array([half_edge, next_corner(np.array([half_edge]))[0]])
    ids: np.ndarray = mesh.vertex_ids[corners[ends]]
    return ids
