"""What has arrived in a followed picture is left alone, and all else comes out the same."""

import numpy as np
import pytest

from stages.edits import flip_edges, flippable, split_edges
from stages.mesh import Mesh
from stages.motion.rest import Rest
from stages.optimize import load_mesh, optimize
from stages.optimize_options import OptimizeOptions
from stages.validate import assert_valid
from tests.kernel_samples import noise, random_mesh, waves
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device
from warp_kernels.energy.workspace import Workspace

WIDTH, HEIGHT = 160, 96
OPTIONS = OptimizeOptions()


def workspace_of(device: str, sums: str = "edges", color: str = "constant") -> Workspace:
    """One with a picture."""
    workspace = Workspace(Device(device), (WIDTH, HEIGHT), COLOR_MODELS[color], sums)
    workspace.load_image(waves(WIDTH, HEIGHT))
    return workspace


def left_half(mesh: Mesh) -> np.ndarray:
    """Vertices of the left half."""
    found: np.ndarray = mesh.vertices[:, 0] < WIDTH / 2
    return found


def pinned(mesh: Mesh, free: np.ndarray) -> np.ndarray:
    """Springs that nothing can stretch, on all vertices that are not free."""
    strengths = np.where(free, 0.0, 1e30)
    return np.column_stack([mesh.vertices, strengths, np.zeros(mesh.vertex_count)])


@pytest.mark.parametrize("sums", ["edges", "fragments"])
@pytest.mark.parametrize("color", ["constant", "linear"])
def test_free_vertices_go_where_they_would_beside_pinned_ones(
    sums: str, color: str, device: str
) -> None:
    """Leaving out what lies around resting vertices changes no bit of the others' ways."""
    mesh = random_mesh(WIDTH, HEIGHT, 120, seed=2)
    free = left_half(mesh)
    resting, held = workspace_of(device, sums, color), workspace_of(device, sums, color)
    load_mesh(resting, mesh, free=free)
    load_mesh(held, mesh, pinned(mesh, free))
    for steps in (1, 4, 3):
        one = optimize(resting, mesh, steps, OPTIONS, dead_band=0.01)
        other = optimize(held, mesh, steps, OPTIONS, dead_band=0.01)
        np.testing.assert_array_equal(one.vertices, other.vertices)
    np.testing.assert_array_equal(one.vertices[~free], mesh.vertices[~free])
    assert (one.vertices[free] != mesh.vertices[free]).any()
    np.testing.assert_array_equal(resting.energies(), held.energies())


def test_what_rested_moves_again(device: str) -> None:
    """After a rest, or at another distance of the variants, no sum is missing or old."""
    mesh = random_mesh(WIDTH, HEIGHT, 120, seed=3)
    used, fresh = workspace_of(device), workspace_of(device)
    load_mesh(used, mesh, free=left_half(mesh))
    there = optimize(used, mesh, 3, OPTIONS)
    load_mesh(used, there, free=~left_half(mesh))
    back = optimize(used, there, 3, OPTIONS, displacement=0.5)
    load_mesh(used, back)
    load_mesh(fresh, back)
    one, other = (optimize(each, back, 4, OPTIONS) for each in (used, fresh))
    np.testing.assert_array_equal(one.vertices, other.vertices)


def test_only_what_changes_is_free() -> None:
    """A triangle whose energy falls frees its corners; the same energies free nobody."""
    mesh = random_mesh(WIDTH, HEIGHT, 80, seed=4)
    energies = 100.0 + np.arange(mesh.triangle_count)
    assert not Rest.after(mesh, energies, mesh, energies).free(mesh).any()
    fallen = energies.copy()
    fallen[7] *= 0.2
    rest = Rest.after(mesh, energies, mesh, fallen)
    assert sorted(np.flatnonzero(rest.free(mesh))) == sorted(mesh.triangles[7])
    expected = np.isin(mesh.triangles, mesh.triangles[7]).any(axis=1)
    np.testing.assert_array_equal(rest.unsettled(mesh), expected)


def test_what_an_edit_made_is_free() -> None:
    """New vertices, and the corners of all triangles that a split or a flip has changed."""
    mesh = random_mesh(WIDTH, HEIGHT, 80, seed=5)
    energies = np.full(mesh.triangle_count, 50.0)
    rest = Rest.after(mesh, energies, mesh, energies)
    edge = mesh.edge_half_edges[flippable(mesh, mesh.edge_half_edges)][:1]
    flipped = flip_edges(mesh, edge)
    assert_valid(flipped)
    pair = np.unique(mesh.triangles[[edge[0] // 3, mesh.twins[edge[0]] // 3]])
    assert sorted(np.flatnonzero(rest.but_for(mesh, flipped).free(flipped))) == sorted(pair)
    ends = mesh.vertices[mesh.triangles.reshape(-1)[[edge[0], mesh.twins[edge[0]]]]]
    divided = split_edges(mesh, edge, ends.mean(axis=0, keepdims=True))
    free = rest.but_for(mesh, divided).free(divided)
    assert free[np.isin(divided.vertex_ids, mesh.vertex_ids[pair])].all()
    assert free.sum() == len(pair) + 1
    again = Rest.after(mesh, energies, divided, np.full(divided.triangle_count, 50.0))
    np.testing.assert_array_equal(again.free(divided), free)


def test_noise_of_a_picture_is_no_reason_to_move(device: str) -> None:
    """Beside what triangles lack anyway a little noise changes no energy by much."""
    mesh = random_mesh(WIDTH, HEIGHT, 60, seed=6)
    workspace = Workspace(Device(device), (WIDTH, HEIGHT), COLOR_MODELS["constant"])
    rng = np.random.default_rng(1)
    picture, energies = noise(WIDTH, HEIGHT), []
    for _ in range(2):
        grain = rng.integers(-3, 4, picture.shape)
        workspace.load_image(np.clip(picture.astype(int) + grain, 0, 255).astype(np.uint8))
        load_mesh(workspace, mesh)
        energies.append(workspace.fit()[1])
    assert Rest.after(mesh, energies[0], mesh, energies[1]).free(mesh).mean() < 0.05
