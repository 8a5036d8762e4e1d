"""Vertices move downhill, within their borders, and never turn a triangle over."""

from threading import Thread

import numpy as np
import pytest

from stages.mesh import Mesh, mesh_of
from stages.validate import assert_valid
from tests.kernel_samples import noise, poisoned_workspace, random_mesh, random_weights, waves
from tests.oracles.gradient import umbrella_gradient, vertex_gradient
from warp_kernels.color_model import COLOR_MODELS, CONSTANT, LINEAR, QUADRATIC, ColorModel
from warp_kernels.device.device import Device

DIRECTION_TOLERANCE = 1e-9
"""Sine of the angle allowed between two directions: rounding of float64 sums."""
WIDTH, HEIGHT = 61, 47
MODELS = pytest.mark.parametrize("model", COLOR_MODELS.values(), ids=COLOR_MODELS)


def freedom(mesh: Mesh) -> np.ndarray:
    """Whether a coordinate of a vertex may change, [V, 2] bool."""
    return np.stack([~mesh.on_left_right, ~mesh.on_top_bottom], axis=1)


@MODELS
def test_first_step_goes_down_the_gradient(model: ColorModel, device: str) -> None:
    """Along each axis a vertex moves against the derivative of Eq. 7, or not at all."""
    picture, mesh = waves(WIDTH, HEIGHT), random_mesh(WIDTH, HEIGHT, 50)
    workspace = poisoned_workspace(Device(device, 1), picture, mesh, model)
    energies = workspace.energies()
    workspace.iterate(1, trust=0.01, regularity=1.0)
    steps = workspace.vertices() - mesh.vertices
    gradients = np.array(
        [vertex_gradient(mesh, energies, v, 1.0) for v in range(mesh.vertex_count)]
    )
    clear = freedom(mesh) & (np.abs(gradients) > 1.0)
    assert clear.sum() > 80
    np.testing.assert_array_equal(np.sign(steps[clear]), -np.sign(gradients[clear]))
    assert np.linalg.norm(steps, axis=1).max() <= 0.01 * (1 + 1e-12)


def test_regularity_pulls_towards_the_middle_of_the_ring(device: str) -> None:
    """Where the picture has one colour, Eq. 9 alone decides: straight to the ring's mean."""
    black = np.zeros((HEIGHT, WIDTH, 3), dtype=np.uint8)
    mesh = random_mesh(WIDTH, HEIGHT, 50)
    workspace = poisoned_workspace(Device(device, 1), black, mesh, CONSTANT)
    workspace.iterate(1, trust=1e3, regularity=1.0)
    steps = workspace.vertices() - mesh.vertices
    inner = np.flatnonzero(freedom(mesh).all(axis=1))
    for vertex in inner:
        goal, step = -umbrella_gradient(mesh, vertex), steps[vertex]
        assert goal @ step > 0
        sine = (goal[0] * step[1] - goal[1] * step[0]) / np.linalg.norm(goal)
        assert abs(sine) <= DIRECTION_TOLERANCE * np.linalg.norm(step)
        assert np.linalg.norm(step) <= np.linalg.norm(goal) * (1 + 1e-12)


def test_ring_of_a_border_vertex_weighs_inner_neighbours_twice(device: str) -> None:
    """The documented deviation from Eq. 9: a vertex at that mean has no reason to slide."""
    # ring of (x, 0): the corners at 0 and 20, and one inner vertex that is off to the right
    inner_x = 17.0
    mean = (0 + 20 + 2 * inner_x) / 4
    mesh = _fan_below(mean, inner_x)
    black = np.zeros((mesh.height, mesh.width, 3), dtype=np.uint8)
    workspace = poisoned_workspace(Device(device, 1), black, mesh, CONSTANT)
    vertex = int(np.flatnonzero((mesh.vertices == (mean, 0)).all(axis=1))[0])
    workspace.iterate(1, trust=1e3, regularity=1.0)
    assert workspace.vertices()[vertex, 0] == pytest.approx(mean, abs=1e-9)


def _fan_below(x: float, inner_x: float) -> Mesh:
    """A square of 20 px with one vertex on its upper border and one inside."""
    points = np.array([[0, 0], [20, 0], [20, 20], [0, 20], [x, 0], [inner_x, 8]])
    rows = [[0, 4, 5], [4, 1, 5], [1, 2, 5], [2, 3, 5], [3, 0, 5]]
    return mesh_of(points, rows, 20, 20)


@MODELS
@pytest.mark.parametrize("sums", ["edges", "fragments"])
def test_a_narrow_probe_finds_the_place_of_edges(sums: str, model: ColorModel, device: str) -> None:
    """A quarter of a pixel sees what a pixel has blurred; sums of another distance are void."""
    mesh = random_mesh(WIDTH, HEIGHT, 30, seed=7)
    totals = []
    for displacement in (1.0, 0.25):
        workspace = poisoned_workspace(Device(device, 1), waves(WIDTH, HEIGHT), mesh, model, sums)
        workspace.iterate(60, trust=0.5, regularity=1e-3)
        workspace.iterate(30, trust=0.1, regularity=1e-3, displacement=displacement)
        totals.append(workspace.energies()[:, 0].sum())
    assert totals[1] < 0.995 * totals[0]


def test_border_vertices_slide_and_corners_stay(device: str) -> None:
    """After many large steps the border is where it was, and its vertices have moved along it."""
    mesh = random_mesh(WIDTH, HEIGHT, 50, border=20)
    workspace = poisoned_workspace(Device(device, 1), waves(WIDTH, HEIGHT), mesh, CONSTANT)
    workspace.iterate(60, trust=2.0, regularity=1e-3)
    moved = workspace.vertices() != mesh.vertices
    free = freedom(mesh)
    assert not moved[~free].any()
    sliding = free.sum(axis=1) == 1
    assert moved[sliding].any(axis=1).mean() > 0.5
    assert moved[free.all(axis=1)].all(axis=1).mean() > 0.9


@MODELS
@pytest.mark.parametrize("trust", [0.2, 5.0, 1e4])
def test_no_triangle_turns_over_on_noise(trust: float, model: ColorModel, device: str) -> None:
    """Two hundred iterations on noise, however far vertices would like to go."""
    mesh = random_mesh(WIDTH, HEIGHT, 80, seed=2)
    workspace = poisoned_workspace(Device(device, 1), noise(WIDTH, HEIGHT), mesh, model)
    for _ in range(20):
        workspace.iterate(10, trust=trust, regularity=1e-3)
        assert_valid(mesh.moved(workspace.vertices()))


@MODELS
def test_energy_falls(model: ColorModel, device: str) -> None:
    """Eighty iterations take away a fifth of the error or more, and every ten of them some.

    Where next to nothing is left steps of a pixel's difference may turn round.
    """
    mesh = random_mesh(WIDTH, HEIGHT, 60, seed=3)
    workspace = poisoned_workspace(Device(device, 1), waves(WIDTH, HEIGHT), mesh, model)
    totals = [workspace.energies()[:, 0].sum()]
    for _ in range(8):
        workspace.iterate(10, trust=0.3, regularity=1e-3)
        totals.append(workspace.energies()[:, 0].sum())
    falling = np.diff(totals[:5]) < 0
    assert (falling | (np.array(totals[:4]) < 0.1 * totals[0])).all()
    assert totals[-1] < 0.8 * totals[0]


@pytest.mark.parametrize("sums", ["edges", "fragments"])
@MODELS
def test_same_bits_on_any_number_of_threads(model: ColorModel, sums: str, device: str) -> None:
    """One, two and three threads, and four times three iterations for twelve: the same vertices."""
    picture, mesh = noise(WIDTH, HEIGHT), random_mesh(WIDTH, HEIGHT, 50)
    results = []
    for threads, rounds in ((1, 1), (1, 4), (2, 1), (3, 1)):
        workspace = poisoned_workspace(Device(device, threads), picture, mesh, model, sums)
        for _ in range(rounds):
            workspace.iterate(12 // rounds, trust=0.5, regularity=1e-3)
        results.append(workspace.vertices())
    for other in results[1:]:
        np.testing.assert_array_equal(other, results[0])


@pytest.mark.parametrize(("model", "weighted"), [(LINEAR, False), (QUADRATIC, True)])
def test_both_sums_move_vertices_alike(model: ColorModel, weighted: bool, device: str) -> None:
    """Equal integers give equal steps: `edges` and `fragments` end at the same bits."""
    picture, mesh = noise(WIDTH, HEIGHT), random_mesh(WIDTH, HEIGHT, 50)
    weights = random_weights(WIDTH, HEIGHT) if weighted else None
    ends = []
    for sums in ("edges", "fragments"):
        workspace = poisoned_workspace(Device(device, 1), picture, mesh, model, sums, weights)
        workspace.iterate(12, trust=0.5, regularity=1e-3)
        ends.append(workspace.vertices())
    np.testing.assert_array_equal(*ends)


@MODELS
def test_mirrored_mesh_moves_alike(model: ColorModel, device: str) -> None:
    """Ten steps over the mirrored picture lead to the mirrored places."""
    picture, mesh = waves(WIDTH, HEIGHT), random_mesh(WIDTH, HEIGHT, 50)
    flipped = (mesh.vertices - (WIDTH, 0)) * (-1, 1)
    mirrored = mesh_of(flipped, mesh.triangles[:, [0, 2, 1]], WIDTH, HEIGHT)
    ends = []
    for pixels, start in ((picture, mesh), (picture[:, ::-1].copy(), mirrored)):
        workspace = poisoned_workspace(Device(device, 1), pixels, start, model)
        workspace.iterate(10, trust=0.3, regularity=1e-3)
        ends.append(workspace.vertices())
    np.testing.assert_allclose((ends[1] - (WIDTH, 0)) * (-1, 1), ends[0], atol=1e-6)


def test_no_iteration_moves_nothing(device: str) -> None:
    """Zero iterations leave every bit; a dead band above all steps does too."""
    mesh = random_mesh(WIDTH, HEIGHT, 50)
    workspace = poisoned_workspace(Device(device, 1), noise(WIDTH, HEIGHT), mesh, CONSTANT)
    workspace.iterate(0, trust=0.5, regularity=1e-3)
    np.testing.assert_array_equal(workspace.vertices(), mesh.vertices)
    workspace.iterate(5, trust=0.5, regularity=1e-3, dead_band=1.0)
    np.testing.assert_array_equal(workspace.vertices(), mesh.vertices)


@pytest.mark.parametrize("sums", ["edges", "fragments"])
@pytest.mark.parametrize("times", [0, 1, 2, 3])
def test_any_number_of_iterations_ends_on_a_large_mesh(times: int, sums: str, device: str) -> None:
    """Past bug: one iteration of a mesh that threads share never came to its end."""
    mesh = random_mesh(211, 133, 300)
    workspace = poisoned_workspace(Device(device, 2), waves(211, 133), mesh, CONSTANT, sums)
    alone = poisoned_workspace(Device(device, 1), waves(211, 133), mesh, CONSTANT, sums)
    steps = {"trust": 0.5, "regularity": 1e-3}
    runner = Thread(target=workspace.iterate, args=(times,), kwargs=steps, daemon=True)
    runner.start()
    runner.join(30)
    assert not runner.is_alive()
    alone.iterate(times, **steps)
    np.testing.assert_array_equal(workspace.vertices(), alone.vertices())
