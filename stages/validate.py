"""What every mesh must obey, checked after each edit and frame, and what is read must."""

from collections.abc import Iterator

import numpy as np

from stages.mesh import Mesh, previous_corner
from stages.snapshot import Snapshot

AREA_TOLERANCE = 1e-9
"""Relative error allowed in the sum of the areas: rounding of a float64 sum, with room."""


READ_TOLERANCE = 1e-6
"""The same for what is read: it need not be told from rounding, but from another picture's mesh."""
LARGEST = 1e30
"""Numbers below this stay finite where drawing takes single precision."""


class InvalidMeshError(ValueError):
    """A mesh that does not cover its domain once; the message names the first violation."""


def assert_valid(mesh: Mesh) -> None:
    """Check a mesh against everything that the other stages take for granted.

    Rows are whole, ids fresh, areas positive and adding up to width x height, every inner edge
    between exactly two triangles that run along it in opposite directions, every border edge on
    the border, one closed fan per vertex, Euler characteristic 1.

    Args:
        mesh: The mesh to check.

    Raises:
        InvalidMeshError: Naming the first violation.
    """
    for check in (_arrays, _ids, _positions, _areas, _edges, _fans):
        for violation in check(mesh):
            raise InvalidMeshError(f"{mesh!r}: {violation}")


def assert_sound(mesh: Mesh) -> None:
    """Check a mesh from a stranger's file: all that kernels read memory by, or divide by.

    Corners are vertices inside of the picture, ids ascend, areas are positive and add up to the
    picture. A tenth of the time of `assert_valid`, which looks at edges as well.

    Args:
        mesh: The mesh; its arrays have the shapes that it takes for granted.

    Raises:
        InvalidMeshError: Naming the first violation.
    """
    for violation in _unsound(mesh):
        raise InvalidMeshError(violation)


def assert_finite(snapshot: Snapshot) -> None:
    """Check the numbers of a snapshot from a stranger's file, apart from its mesh.

    Raises:
        InvalidMeshError: Naming the first that is none, or that cannot be.
    """
    # a comparison with what is no number is never true
    colors, energies = snapshot.coefficients, snapshot.energies
    if not (colors.max() < LARGEST and colors.min() > -LARGEST):
        raise InvalidMeshError("a colour that is no number")
    if not (energies.min() >= 0 and energies.max() < LARGEST):
        raise InvalidMeshError("an error that is no number")
    if snapshot.counts.min() < 0:
        raise InvalidMeshError("a triangle of fewer than no pixels")
    limits = snapshot.limits
    if limits is not None and (limits[:, 0] > limits[:, 1]).any():
        raise InvalidMeshError("a colour between limits that leave none")


def _unsound(mesh: Mesh) -> Iterator[str]:
    for kind, ids, following in (
        ("vertices", mesh.vertex_ids, mesh.next_vertex_id),
        ("triangles", mesh.triangle_ids, mesh.next_triangle_id),
    ):
        if ids[0] < 0 or ids[-1] >= following or not (ids[1:] > ids[:-1]).all():
            yield f"the numbers of its {kind} do not ascend from 0 to {following - 1}"
    if not 0 <= mesh.triangles.min() <= mesh.triangles.max() < mesh.vertex_count:
        yield "a triangle of unknown vertices"
    right, down = mesh.vertices.max(axis=0)
    if not (mesh.vertices.min() >= 0 and right <= mesh.width and down <= mesh.height):
        yield "a vertex outside of the picture"
    if not mesh.areas.min() > 0:
        yield "a triangle without an area"
    domain = mesh.width * mesh.height
    if not abs(mesh.areas.sum() - domain) <= READ_TOLERANCE * domain:
        yield f"triangles of {mesh.areas.sum():g} px^2 over a picture of {domain}"


def _arrays(mesh: Mesh) -> Iterator[str]:
    V, T = mesh.vertex_count, mesh.triangle_count
    if mesh.vertices.shape != (V, 2) or mesh.triangles.shape != (T, 3):
        yield f"vertices {mesh.vertices.shape} must be [V, 2], triangles {mesh.triangles.shape}"
    if T == 0:
        yield "there is no triangle"
    outside = np.flatnonzero(((mesh.triangles < 0) | (mesh.triangles >= V)).any(axis=1))
    if len(outside):
        yield f"triangle {outside[0]} names vertices {mesh.triangles[outside[0]]} of {V}"
    unused = np.flatnonzero(np.bincount(mesh.triangles.ravel(), minlength=V) == 0)
    if len(unused):
        yield f"vertex {unused[0]} belongs to no triangle"


def _ids(mesh: Mesh) -> Iterator[str]:
    for kind, ids, count, following in (
        ("vertex", mesh.vertex_ids, mesh.vertex_count, mesh.next_vertex_id),
        ("triangle", mesh.triangle_ids, mesh.triangle_count, mesh.next_triangle_id),
    ):
        if ids.shape != (count,):
            yield f"{kind} ids of shape {ids.shape} for {count}"
        if len(np.unique(ids)) != count:
            yield f"two of the {kind} ids are equal"
        if count and (ids.min() < 0 or ids.max() >= following):
            yield f"{kind} ids {ids.min()}..{ids.max()} must lie in 0..{following - 1}"


def _positions(mesh: Mesh) -> Iterator[str]:
    size = np.array([mesh.width, mesh.height])
    inside = ((mesh.vertices >= 0) & (mesh.vertices <= size)).all(axis=1)
    for vertex in np.flatnonzero(~inside):  # NaN lands here as well
        yield f"vertex {vertex} at {mesh.vertices[vertex]} lies outside the domain"


def _areas(mesh: Mesh) -> Iterator[str]:
    for triangle in np.flatnonzero(~(mesh.areas > 0)):
        yield f"triangle {triangle} has area {mesh.areas[triangle]} px^2"
    total, domain = mesh.areas.sum(), mesh.width * mesh.height
    if abs(total - domain) > AREA_TOLERANCE * domain:
        yield f"areas add up to {total} px^2 instead of {domain}"


def _edges(mesh: Mesh) -> Iterator[str]:
    tails = mesh.triangles.ravel().astype(np.int64)
    heads = mesh.triangles[:, [1, 2, 0]].ravel().astype(np.int64)
    directed = tails * mesh.vertex_count + heads
    numbers, uses = np.unique(directed, return_counts=True)
    for number in numbers[uses > 1]:
        ends = divmod(int(number), mesh.vertex_count)
        yield f"two triangles run along edge {ends} in the same direction"
    # Directed edges are unique now, so an edge has at most two triangles and its twin is sound.
    twins = mesh.twins
    inner = np.flatnonzero(twins >= 0)
    if not np.array_equal(twins[twins[inner]], inner):
        yield "the twin of a twin is another half-edge"
    if not np.array_equal(directed[twins[inner]], (heads * mesh.vertex_count + tails)[inner]):
        yield "a twin does not run the other way"
    size = np.array([mesh.width, mesh.height])
    start, end = mesh.vertices[tails], mesh.vertices[heads]
    along = ((start == end) & ((start == 0) | (start == size))).any(axis=1)
    for half_edge in np.flatnonzero((twins < 0) & ~along):
        ends = (int(tails[half_edge]), int(heads[half_edge]))
        yield f"edge {ends} has one triangle but does not lie on the border"


def _fans(mesh: Mesh) -> Iterator[str]:
    # it takes a quarter of a second to import, and of a conversion only what goes on needs it
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    count = 3 * mesh.triangle_count
    corners = np.arange(count, dtype=np.int32)
    around = mesh.twins[previous_corner(corners)]
    linked = np.flatnonzero(around >= 0)
    links = coo_array((np.ones(len(linked)), (linked, around[linked])), shape=(count, count))
    fans, fan_of = connected_components(links, directed=False)
    if fans != mesh.vertex_count:
        owner = np.zeros(fans, dtype=np.int64)
        owner[fan_of] = mesh.triangles.ravel()
        torn = np.flatnonzero(np.bincount(owner, minlength=mesh.vertex_count) > 1)
        yield f"the triangles at vertex {torn[0]} are more than one fan"
    euler = mesh.vertex_count - mesh.edge_count + mesh.triangle_count
    if euler != 1:
        yield f"Euler characteristic {euler} instead of 1"
