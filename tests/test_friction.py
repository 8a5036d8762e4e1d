"""Vertices stay where they are while the picture around them stays as it is."""

import numpy as np
import pytest

from stages.edits import split_triangles
from stages.layouts.importance import Importance
from stages.mesh import Mesh
from stages.motion.advect import Carried
from stages.motion.friction import AS_IT_WAS, LARGEST, SLIDE, TURNS, friction_of
from stages.motion.springs import springs_of
from stages.optimize import load_mesh, optimize
from stages.optimize_options import OptimizeOptions
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from tests.kernel_samples import frame_of, random_mesh, waves
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device
from warp_kernels.energy.workspace import Workspace

WIDTH, HEIGHT = 160, 96
OPTIONS = OptimizeOptions()


@pytest.fixture
def workspace(device: str) -> Workspace:
    """One with a picture."""
    made = Workspace(Device(device), (WIDTH, HEIGHT), COLOR_MODELS["constant"])
    made.load_image(waves(WIDTH, HEIGHT))
    return made


def test_friction_holds_at_rest_and_not_on_the_way(workspace: Workspace) -> None:
    """A step below it is not taken, a longer one is, and who has left goes on freely."""
    mesh = random_mesh(WIDTH, HEIGHT, 120, seed=2)
    places = np.column_stack([mesh.vertices, np.zeros(mesh.vertex_count)])

    def after(friction: float, steps: int) -> np.ndarray:
        """Where vertices stand after some steps."""
        springs = np.column_stack([places, np.full(mesh.vertex_count, friction)])
        load_mesh(workspace, mesh, springs)
        return optimize(workspace, mesh, steps, OPTIONS, dead_band=0.1).vertices

    free = after(0.0, 1)
    wanted = np.linalg.norm(free - mesh.vertices, axis=1)
    bar = 0.3
    held = after(bar, 1)
    stays = (held == mesh.vertices).all(axis=1)
    assert (stays & (wanted > 0.1)).any()
    assert (wanted[stays] < bar).all()
    assert not stays.all()
    np.testing.assert_array_equal(held[~stays], free[~stays])
    np.testing.assert_array_equal(after(1e9, 5), mesh.vertices)
    # on the way steps are taken that would be too short to leave by
    ways = np.linalg.norm(after(bar, 2) - held, axis=1)[~stays]
    assert ((ways > 0) & (ways < bar)).any()


def in_turn(mesh: Mesh, turn: int = 0) -> np.ndarray:
    """Vertices that are free in a frame whatever lies around them, shape [V] bool."""
    found: np.ndarray = (mesh.vertex_ids + turn) % TURNS == 0
    return found


def test_friction_ends_where_anything_changes() -> None:
    """At the corners of a triangle that changes, for who is taken along, and for who is new."""
    mesh = random_mesh(WIDTH, HEIGHT, 80, seed=4)
    had = np.full(mesh.triangle_count, 100.0)
    energies = had.copy()
    energies[7] *= 1.0 + 40 * AS_IT_WAS
    found = friction_of(mesh, had, mesh, energies, 0)
    expected = in_turn(mesh) | np.isin(np.arange(mesh.vertex_count), mesh.triangles[7])
    np.testing.assert_array_equal(found, np.where(expected, 0.0, LARGEST))
    inner = ~mesh.on_left_right & ~mesh.on_top_bottom & ~in_turn(mesh)
    slow, fast = np.flatnonzero(inner)[:2]
    vertices = mesh.vertices.copy()
    vertices[[slow, fast], 0] += (0.5 * SLIDE, SLIDE)
    found = friction_of(mesh, had, mesh.moved(vertices), had, 0)
    np.testing.assert_allclose(found[[slow, fast]], (0.5 * LARGEST, 0.0), atol=1e-9)
    divided = split_triangles(mesh, np.array([3]))
    new = divided.vertex_ids >= mesh.next_vertex_id
    same = np.full(divided.triangle_count, 100.0)
    found = friction_of(mesh, had, divided, same, 1)
    assert new.sum() == 1
    assert (found[new] == 0.0).all()


def test_all_are_free_in_turn() -> None:
    """In so many frames every vertex is free once, in whatever frame one begins."""
    mesh = random_mesh(WIDTH, HEIGHT, 80, seed=4)
    had = np.full(mesh.triangle_count, 100.0)
    free = [friction_of(mesh, had, mesh, had, 7 + turn) == 0.0 for turn in range(TURNS)]
    np.testing.assert_array_equal(np.sum(free, axis=0), 1)


def test_friction_goes_with_the_vertices() -> None:
    """Those of the seed have theirs, new ones have none."""
    mesh = random_mesh(WIDTH, HEIGHT, 40, seed=5)
    friction = np.linspace(0.0, 1.0, mesh.vertex_count)
    seed = Carried(mesh, np.ones(mesh.vertex_count), friction=friction)
    divided = split_triangles(mesh, np.array([3, 9]))
    springs = springs_of(divided, seed, 1.0, None)
    old = divided.vertex_ids < mesh.next_vertex_id
    np.testing.assert_array_equal(springs[old, 3], friction)
    np.testing.assert_array_equal(springs[~old, 3], 0.0)


def test_noise_moves_few_vertices_of_a_still_picture() -> None:
    """Past bug: before a camera that stood still two thirds of the vertices moved every frame."""
    rng = np.random.default_rng(1)
    still = waves(WIDTH, HEIGHT)
    noisy = [np.clip(still + rng.normal(0, 3, still.shape), 0, 255) for _ in range(4)]
    pictures = [each.astype(np.uint8) for each in noisy]
    options = TriangulateOptions(iterations=120, refine=RefineOptions(triangles=120))
    solver = Triangulator(Device("cpu"), (WIDTH, HEIGHT), options)
    before = solver.first(frame_of(pictures[0], 0), Importance(), rng)
    for number, picture in enumerate(pictures[1:], 1):
        seed = Carried(before.mesh, np.ones(before.mesh.vertex_count))
        after = solver.next(frame_of(picture, number), seed, before)
        _, was, now = np.intersect1d(
            seed.mesh.vertex_ids, after.mesh.vertex_ids, return_indices=True
        )
        moved = (after.mesh.vertices[now] != seed.mesh.vertices[was]).any(axis=1)
        assert moved.mean() < 0.3
        before = after
