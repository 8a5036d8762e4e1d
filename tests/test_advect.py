"""Vertices ride the flow, and nothing folds."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import HEIGHT, WIDTH, random_mesh, scrambled

from stages.flows.field import FlowField
from stages.flows.passage import Passage
from stages.flows.view import View
from stages.layouts.grid import Grid
from stages.mesh import Mesh
from stages.motion.advect import LOWEST, advect
from stages.validate import assert_valid


def along(flow: FlowField) -> Passage:
    """A passage between plain pictures, in which no patch speaks against the flow."""
    plain = np.zeros((flow.height, flow.width, 3), dtype=np.uint8)
    return Passage(flow, View(plain), View(plain))


def constant(mesh: Mesh, dx: float, dy: float) -> Passage:
    """The same motion everywhere."""
    vectors = np.full((1, 1, 2), (dx, dy), dtype=np.float32)
    return along(FlowField(mesh.width, mesh.height, vectors))


def grid() -> Mesh:
    """A regular mesh of cells of 10 px."""
    return Grid().build(np.zeros((60, 80, 3), dtype=np.uint8), 96, np.random.default_rng(0))


def test_constant_flow_moves_inner_vertices_exactly() -> None:
    """A small constant motion arrives at every inner vertex to the bit."""
    mesh = grid()
    moved = advect(mesh, constant(mesh, 2.5, -1.25)).mesh
    assert_valid(moved)
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    assert inner.sum() == 35
    assert np.array_equal(moved.vertices[inner], mesh.vertices[inner] + (2.5, -1.25))


def test_border_vertices_slide_and_corners_stay() -> None:
    """On the border only the component along it counts."""
    mesh = grid()
    moved = advect(mesh, constant(mesh, 2.5, -1.25)).mesh
    corner = mesh.on_left_right & mesh.on_top_bottom
    for fixed, step in (
        (mesh.on_left_right & ~corner, (0, -1.25)),
        (mesh.on_top_bottom & ~corner, (2.5, 0)),
        (corner, (0, 0)),
    ):
        assert np.array_equal(moved.vertices[fixed], mesh.vertices[fixed] + step)


def test_ids_rows_and_tables_are_kept() -> None:
    """Only positions change; topology tables are carried over."""
    mesh = grid()
    twins = mesh.twins
    moved = advect(mesh, constant(mesh, 1, 1)).mesh
    assert np.array_equal(moved.triangles, mesh.triangles)
    assert np.array_equal(moved.triangle_ids, mesh.triangle_ids)
    assert np.array_equal(moved.vertex_ids, mesh.vertex_ids)
    assert moved.twins is twins


def test_no_motion_changes_no_bit() -> None:
    """A still flow leaves a mesh with thin triangles exactly as it is."""
    mesh = scrambled(random_mesh(0), 0)
    moved = advect(mesh, along(FlowField.still(WIDTH, HEIGHT))).mesh
    assert np.array_equal(moved.vertices, mesh.vertices)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), size=st.sampled_from([0.5, 5.0, 50.0, 1e4]))
def test_wild_flows_never_fold(seed: int, size: float) -> None:
    """Whatever the motion, a valid mesh stays valid; what does not collapse is not thinned far."""
    mesh = scrambled(random_mesh(seed % 6), seed, rounds=3)
    rng = np.random.default_rng(seed)
    vectors = size * rng.standard_normal((9, 13, 2))
    moved = advect(mesh, along(FlowField(WIDTH, HEIGHT, vectors.astype(np.float32)))).mesh
    assert_valid(moved)
    if moved.triangle_count == mesh.triangle_count:
        assert (moved.heights >= np.minimum(LOWEST, 0.5 * mesh.heights)).all()


@pytest.mark.parametrize("direction", [(300.0, 0.0), (0.0, -300.0), (-500.0, 500.0)])
def test_repeated_rush_against_a_border_stays_valid(direction: tuple[float, float]) -> None:
    """Twenty frames that push everything out of the picture leave a valid mesh."""
    mesh = random_mesh(1)
    for _ in range(20):
        mesh = advect(mesh, constant(mesh, *direction)).mesh
        assert_valid(mesh)


def test_a_fold_changes_only_its_neighbourhood() -> None:
    """A tear in the flow collapses triangles there and holds back nothing else."""
    mesh = grid()
    vectors = np.full((6, 8, 2), (1, 0), dtype=np.float32)
    vectors[2:4, 2:4] = (30, 0)
    moved = advect(mesh, along(FlowField(80, 60, vectors))).mesh
    assert_valid(moved)
    far = (mesh.vertices[:, 0] >= 60) & ~mesh.on_left_right
    places = np.searchsorted(moved.vertex_ids, mesh.vertex_ids[far])
    assert np.array_equal(moved.vertices[places], mesh.vertices[far] + (1, 0))
