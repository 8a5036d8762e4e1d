"""The mesh type, its derived tables, and the validator that catches planted faults."""

from dataclasses import replace

import numpy as np
import pytest
from meshes import HEIGHT, WIDTH, random_mesh, two_triangles

from stages.mesh import Mesh, heights_of, mesh_of, next_corner, previous_corner, twins_of
from stages.validate import InvalidMeshError, assert_valid


@pytest.mark.parametrize("seed", range(5))
def test_random_meshes_are_valid(seed: int) -> None:
    """A Delaunay mesh of random points passes every check."""
    assert_valid(random_mesh(seed))


@pytest.mark.parametrize("seed", range(3))
def test_twins_agree_with_a_dictionary(seed: int) -> None:
    """The twin table equals one built edge by edge."""
    mesh = random_mesh(seed)
    tails = mesh.triangles.ravel().tolist()
    heads = mesh.triangles[:, [1, 2, 0]].ravel().tolist()
    place = {ends: e for e, ends in enumerate(zip(tails, heads, strict=True))}
    expected = [place.get((b, a), -1) for a, b in zip(tails, heads, strict=True)]
    assert mesh.twins.tolist() == expected


def test_twins_survive_numbers_too_large_to_pack() -> None:
    """Vertex numbers in the millions take the other sort and give the same twins."""
    far = np.array([[0, 1, 2_000_000_000], [2_000_000_000, 1, 3]], dtype=np.int32)
    near = np.array([[0, 1, 2], [2, 1, 3]], dtype=np.int32)
    assert twins_of(far, 2_000_000_001).tolist() == twins_of(near, 4).tolist()


@pytest.mark.parametrize("seed", range(3))
def test_edges_name_every_half_edge_once(seed: int) -> None:
    """Each half-edge runs along its edge, backwards exactly where it is marked so."""
    mesh = random_mesh(seed)
    ends = np.stack([mesh.triangles.ravel(), mesh.triangles[:, [1, 2, 0]].ravel()], axis=1)
    expected = mesh.edge_vertices[mesh.half_edge_to_edge]
    expected[mesh.half_edge_reversed] = expected[mesh.half_edge_reversed, ::-1]
    assert np.array_equal(ends, expected)
    assert np.array_equal(mesh.half_edge_to_edge[mesh.edge_half_edges], np.arange(mesh.edge_count))
    assert mesh.edge_count == mesh.vertex_count + mesh.triangle_count - 1


@pytest.mark.parametrize("seed", range(3))
def test_fans_list_the_corners_of_every_vertex(seed: int) -> None:
    """Fans hold each vertex's corners in ascending order."""
    mesh = random_mesh(seed)
    corners = mesh.triangles.ravel()
    for vertex in range(mesh.vertex_count):
        fan = mesh.fan_corners[mesh.fan_offsets[vertex] : mesh.fan_offsets[vertex + 1]]
        assert fan.tolist() == np.flatnonzero(corners == vertex).tolist()


def test_tables_have_the_types_that_kernels_read() -> None:
    """Tables are int32 or bool, contiguous and read-only."""
    mesh = two_triangles()
    for name in ("triangles", "twins", "edge_half_edges", "edge_vertices", "half_edge_to_edge"):
        assert getattr(mesh, name).dtype == np.int32, name
    assert mesh.fan_offsets.dtype == mesh.fan_corners.dtype == np.int32
    assert mesh.half_edge_reversed.dtype == np.bool_
    assert mesh.vertices.dtype == mesh.areas.dtype == np.float64
    for array in (mesh.vertices, mesh.twins, mesh.edge_vertices, mesh.fan_corners, mesh.areas):
        assert array.flags.c_contiguous
        assert not array.flags.writeable


def test_a_mesh_does_not_share_writable_arrays() -> None:
    """Writing to the arrays given to a mesh changes nothing in it, nor locks them."""
    points = two_triangles().vertices.copy()
    mesh = mesh_of(points, [[0, 1, 3], [1, 2, 3]], 4, 4)
    points[0] = 2.0
    assert mesh.vertices[0].tolist() == [0.0, 0.0]


def test_areas_heights_and_border_of_a_known_triangle() -> None:
    """A right triangle of sides 3, 4, 5 has area 6 and smallest height 12 / 5."""
    mesh = mesh_of(np.array([[0, 0], [4, 0], [0, 3], [4, 3]]), [[0, 2, 1], [1, 3, 2]], 4, 3)
    assert mesh.areas.tolist() == [6.0, 6.0]
    assert mesh.heights == pytest.approx([2.4, 2.4])
    assert mesh.on_left_right.all()
    assert mesh.on_top_bottom.all()


def test_height_of_a_point_is_zero() -> None:
    """Three equal corners have height 0, not a division by zero."""
    assert heights_of(np.ones((1, 3, 2))).tolist() == [0.0]


def test_next_and_previous_corner_are_inverse() -> None:
    """Going on and back around a triangle returns to the same half-edge."""
    half_edges = np.arange(9)
    assert np.array_equal(previous_corner(next_corner(half_edges)), half_edges)
    assert next_corner(half_edges).tolist() == [1, 2, 0, 4, 5, 3, 7, 8, 6]


def test_a_moved_mesh_keeps_its_topology_and_renews_its_geometry() -> None:
    """`moved` carries tables over without mixing up areas of before and after."""
    mesh = random_mesh(0)
    _ = mesh.twins, mesh.edge_vertices, mesh.fan_corners, mesh.areas
    moved = mesh.moved(mesh.vertices * 0.5)
    assert moved.twins is mesh.twins
    assert moved.fan_corners is mesh.fan_corners
    assert moved.areas == pytest.approx(mesh.areas / 4)
    assert np.array_equal(moved.triangle_ids, mesh.triangle_ids)


def _without_last_triangle(mesh: Mesh) -> Mesh:
    return replace(mesh, triangles=mesh.triangles[:-1], triangle_ids=mesh.triangle_ids[:-1])


def _with_vertex(mesh: Mesh, x: float, y: float) -> Mesh:
    return replace(
        mesh,
        vertices=np.concatenate([mesh.vertices, [[x, y]]]),
        vertex_ids=np.append(mesh.vertex_ids, mesh.next_vertex_id),
        next_vertex_id=mesh.next_vertex_id + 1,
    )


def _with_moved(mesh: Mesh, vertex: int, x: float, y: float) -> Mesh:
    vertices = mesh.vertices.copy()
    vertices[vertex] = x, y
    return mesh.moved(vertices)


def _turned_over(mesh: Mesh) -> Mesh:
    rows = mesh.triangles.copy()
    rows[7] = rows[7, ::-1]
    return replace(mesh, triangles=rows)


PLANTED = {
    "hole": (_without_last_triangle, "areas add up"),
    "unused vertex": (lambda mesh: _with_vertex(mesh, 1, 1), "belongs to no triangle"),
    "turned over": (_turned_over, "has area"),
    "outside": (lambda mesh: _with_moved(mesh, 0, -1, 0), "outside the domain"),
    "not a number": (lambda mesh: _with_moved(mesh, 30, np.nan, 0), "outside the domain"),
    "folded": (lambda mesh: _with_moved(mesh, 30, WIDTH, HEIGHT), "has area"),
    "off the border": (lambda mesh: _with_moved(mesh, 0, 1e-3, 1e-3), "areas add up"),
    "off the border by a hair": (
        lambda mesh: _with_moved(mesh, 0, 1e-12, 0),
        "does not lie on the border",
    ),
    "equal ids": (
        lambda mesh: replace(mesh, vertex_ids=np.zeros_like(mesh.vertex_ids)),
        "are equal",
    ),
    "id not given yet": (lambda mesh: replace(mesh, next_triangle_id=3), "must lie in"),
    "unknown vertex": (lambda mesh: replace(mesh, triangles=mesh.triangles + 1), "names vertices"),
    "wrong shape": (lambda mesh: replace(mesh, vertex_ids=mesh.vertex_ids[1:]), "ids of shape"),
    "empty": (
        lambda mesh: replace(mesh, triangles=mesh.triangles[:0], triangle_ids=[]),
        "no triangle",
    ),
}


@pytest.mark.parametrize("fault", PLANTED)
def test_planted_faults_are_caught(fault: str) -> None:
    """Each planted fault is named by the validator."""
    plant, message = PLANTED[fault]
    with pytest.raises(InvalidMeshError, match=message):
        assert_valid(plant(random_mesh(1)))


def test_a_doubled_triangle_is_caught() -> None:
    """Two triangles along one edge in one direction are an error even if areas add up."""
    square = two_triangles()
    with pytest.raises(InvalidMeshError, match="same direction"):
        assert_valid(replace(square, triangles=[[0, 1, 3], [0, 1, 2]]))


def test_a_torn_fan_is_caught() -> None:
    """Two fans that meet in one vertex are an error although areas add up."""
    points = np.array([[0, 0], [2, 0], [1, 1], [0, 2], [2, 2]])
    bow_tie = mesh_of(points, [[0, 1, 2], [3, 2, 4]], 2, 1)
    with pytest.raises(InvalidMeshError):
        assert_valid(bow_tie)


def test_overlap_that_keeps_the_area_is_caught() -> None:
    """A sheet folded over itself is an error even when its area is that of the domain."""
    points = np.array([[0, 0], [2, 0], [2, 2], [0, 2], [1, 1]])
    twice = mesh_of(points, [[0, 1, 4], [1, 2, 4], [0, 1, 4], [1, 2, 4]], 2, 2)
    with pytest.raises(InvalidMeshError):
        assert_valid(twice)
