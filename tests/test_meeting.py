"""One mesh becomes another little by little, and stays valid on the way."""

from dataclasses import replace

import numpy as np
import pytest

from stages.edits import collapse_edges, collapsible, flip_edges, flippable, split_edges
from stages.edits.independent import independent_collapses, independent_flips
from stages.hand.insert import Insert
from stages.hand.locks import NO_LOCKS
from stages.hand.worked import Worked
from stages.mesh import Mesh
from stages.motion.correspondence import by_vertex_id, kept_triangles
from stages.motion.meeting import Meeting
from stages.validate import assert_valid
from tests.meshes import WIDTH, random_mesh


def changed(mesh: Mesh, seed: int, part: float = 0.1) -> Mesh:
    """What a mesh became elsewhere: some flips, splits and collapses, vertices moved a bit."""
    rng = np.random.default_rng(seed)
    for kind in range(3):
        edges = mesh.edge_half_edges[rng.random(mesh.edge_count) < part].astype(np.int64)
        if kind == 0:
            edges = edges[flippable(mesh, edges, min_height=0.5)]
            mesh = flip_edges(mesh, edges[independent_flips(mesh, edges)])
        elif kind == 1:
            mesh = split_edges(mesh, edges[independent_flips(mesh, edges)])
        else:
            edges = edges[collapsible(mesh, edges, min_height=0.5)]
            mesh = collapse_edges(mesh, edges[independent_collapses(mesh, edges)])
    steps = rng.normal(0, 0.02, mesh.vertices.shape)
    steps[mesh.on_left_right | mesh.on_top_bottom] = 0.0
    moved = mesh.moved(mesh.vertices + steps)
    return moved if (moved.areas > 0).all() else mesh


def renumbered(mesh: Mesh, following: int) -> Mesh:
    """The mesh with fresh numbers to come that another mesh has not given."""
    return replace(mesh, next_vertex_id=following, next_triangle_id=following)


@pytest.mark.parametrize("seed", range(12))
def test_every_mesh_on_the_way_is_valid(seed: int) -> None:
    begun = random_mesh(seed)
    one = changed(begun, seed)
    other = changed(renumbered(begun, 1000), seed + 100)
    meeting = Meeting(one, other)
    places, areas = meeting.spread()
    assert areas.sum() == pytest.approx(one.areas[kept_triangles(other, one) < 0].sum(), rel=0.2)
    found = []
    for share, line in ((0.0, -1.0), (0.5, WIDTH / 2), (1.0, WIDTH + 1.0)):
        mesh = meeting.between(share, line)
        if mesh is not None:
            assert_valid(mesh)
            assert (np.diff(mesh.triangle_ids) > 0).all()
            found.append(mesh)
    assert len(found) >= 2
    begin = meeting.between(0.0, -1.0)
    if begin is not None and not len(places):
        assert np.array_equal(by_vertex_id(begin), by_vertex_id(one))


def test_ends_are_the_two_meshes() -> None:
    begun = random_mesh(3)
    one, other = changed(begun, 1), changed(renumbered(begun, 1000), 2)
    meeting = Meeting(one, other)
    for share, line, wanted in ((0.0, -1.0, one), (1.0, WIDTH + 1.0, other)):
        mesh = meeting.between(share, line)
        assert mesh is not None
        assert (kept_triangles(wanted, mesh) >= 0).all()
        assert np.array_equal(mesh.vertices, wanted.vertices)


def test_what_is_held_comes_and_all_else_stays() -> None:
    begun = random_mesh(5, inner=150)
    one = changed(begun, 1)
    edited = Insert(0, (48.0, 32.0), 9.0, 6).apply(Worked(renumbered(begun, 1000)))
    other = changed(edited.mesh, 0, part=0.0)
    mesh = Meeting(one, other).only(edited.locks)
    assert mesh is not None
    assert_valid(mesh)
    assert np.isin(edited.locks.vertices, mesh.vertex_ids).all()
    far = (np.abs(one.corners - (48, 32)) > 24).any(axis=2).all(axis=1)
    assert (kept_triangles(mesh, one)[far] >= 0).mean() > 0.95
    assert Meeting(one, one).only(NO_LOCKS) is not None
