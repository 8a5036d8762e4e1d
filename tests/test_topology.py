"""Changes of topology: what is measured is what an edit brings, and edits lead to the goal."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from meshes import scrambled
from test_legalise import assert_delaunay

from stages.edits import collapse_edges, collapsible, flip_edges, flippable, split_edges
from stages.mesh import Mesh, heights_of, next_corner, previous_corner
from stages.motion.correspondence import kept_triangles
from stages.topology import TOPOLOGIES, Topology
from stages.topology.appraise import Appraiser
from stages.topology.energy import Energy
from stages.topology.goal import Goal
from stages.topology.ranking import LEAST_GAIN
from stages.validate import assert_valid
from tests.kernel_samples import (
    noise,
    poisoned_workspace,
    random_mesh,
    random_weights,
    waves,
)
from warp_kernels.color_model import COLOR_MODELS, LINEAR, ColorModel
from warp_kernels.device.device import Device
from warp_kernels.energy.topology_gains import IMPOSSIBLE, SPLIT_PLACES

WIDTH, HEIGHT = 61, 47
LEAST_HEIGHT = 0.5
"""Changes that leave a thinner triangle are impossible [px]."""
TOLERANCE = {"rtol": 1e-9, "atol": 1e-3}
"""Rounding of the energies' differences [code value^2 px]."""
MODELS = pytest.mark.parametrize("model", COLOR_MODELS.values(), ids=COLOR_MODELS)
SEEDS = pytest.mark.parametrize("seed", range(2))


@cache
def mesh_of_seed(seed: int) -> Mesh:
    """A mesh of about 90 triangles that is not Delaunay, corners on 1/16 px."""
    return scrambled(random_mesh(WIDTH, HEIGHT, 40, seed=seed, grid=16), seed, rounds=2)


def appraiser_of(device: str, model: ColorModel, picture: np.ndarray, mesh: Mesh) -> Appraiser:
    """An appraiser that knows a picture; a mesh of the picture's size lies in its memory."""
    return Appraiser(poisoned_workspace(Device(device, 2), picture, mesh, model), LEAST_HEIGHT)


def total(appraiser: Appraiser, mesh: Mesh) -> float:
    """Energy of a whole mesh [code value^2 px]."""
    return float(appraiser.energies(mesh).sum())


@SEEDS
@MODELS
def test_flip_gains_are_what_flips_save(model: ColorModel, seed: int, device: str) -> None:
    """Each flip by itself, against the whole mesh; the others are marked as impossible."""
    mesh = mesh_of_seed(seed)
    appraiser = appraiser_of(device, model, noise(WIDTH, HEIGHT), mesh)
    before = total(appraiser, mesh)
    edges = mesh.edge_half_edges
    gains = appraiser.flip_gains(edges)
    possible = flippable(mesh, edges, LEAST_HEIGHT)
    assert 20 < possible.sum() < len(edges) - 10
    np.testing.assert_array_equal(gains > -IMPOSSIBLE, possible)
    saved = [before - total(appraiser, flip_edges(mesh, [edge])) for edge in edges[possible]]
    np.testing.assert_allclose(gains[possible], saved, **TOLERANCE)


@SEEDS
@MODELS
def test_split_gains_are_what_splits_save(model: ColorModel, seed: int, device: str) -> None:
    """Each split by itself at its own place, of inner edges and of those on the border."""
    mesh = mesh_of_seed(seed)
    appraiser = appraiser_of(device, model, noise(WIDTH, HEIGHT), mesh)
    before = total(appraiser, mesh)
    edges = mesh.edge_half_edges
    gains, points = appraiser.split_gains(edges)
    chosen = np.flatnonzero(gains > -IMPOSSIBLE)
    assert (mesh.twins[edges[chosen]] < 0).any()
    saved = [before - total(appraiser, split_edges(mesh, [edges[n]], points[[n]])) for n in chosen]
    np.testing.assert_allclose(gains[chosen], saved, **TOLERANCE)


@SEEDS
def test_splits_take_the_best_place(seed: int, device: str) -> None:
    """No place that is looked at saves more; where none is possible the split is not either."""
    mesh = mesh_of_seed(seed)
    appraiser = appraiser_of(device, LINEAR, noise(WIDTH, HEIGHT), mesh)
    before = total(appraiser, mesh)
    edges = mesh.edge_half_edges
    gains, points = appraiser.split_gains(edges)
    best = np.full(len(edges), -IMPOSSIBLE)
    for along, across in SPLIT_PLACES:
        for number, edge in enumerate(edges):
            if across and mesh.twins[edge] < 0:
                continue
            point = split_place(mesh, edges[[number]], along, across)
            try:
                split = split_edges(mesh, edges[[number]], point)
            except ValueError:
                continue
            if split.heights[_changed(mesh, split)].min() >= LEAST_HEIGHT:
                best[number] = max(best[number], before - total(appraiser, split))
    np.testing.assert_allclose(gains, best, **TOLERANCE)
    assert (points != mesh.vertices[mesh.edge_vertices].mean(axis=1)).any()


def split_place(mesh: Mesh, edge: np.ndarray, along: float, across: float) -> np.ndarray:
    """A place of `SPLIT_PLACES` beside an edge [px], [1, 2]."""
    corners = mesh.vertices[mesh.triangles.reshape(-1)]
    point = corners[edge] + along * (corners[next_corner(edge)] - corners[edge])
    side = edge if across >= 0 else mesh.twins[edge]
    return point + abs(across) * (corners[previous_corner(side)] - point)


@SEEDS
@MODELS
def test_collapse_costs_are_what_collapses_add(model: ColorModel, seed: int, device: str) -> None:
    """Each legal collapse by itself, within the picture and along its border."""
    mesh = mesh_of_seed(seed)
    appraiser = appraiser_of(device, model, noise(WIDTH, HEIGHT), mesh)
    before = total(appraiser, mesh)
    half_edges = np.arange(3 * mesh.triangle_count)
    costs = appraiser.collapse_costs(half_edges)
    legal = collapsible(mesh, half_edges, LEAST_HEIGHT)
    assert legal.sum() > 40
    assert (mesh.twins[half_edges[legal]] < 0).any()
    added = [total(appraiser, collapse_edges(mesh, [edge])) - before for edge in half_edges[legal]]
    np.testing.assert_allclose(costs[legal], added, **TOLERANCE)


@MODELS
def test_weighted_gains_are_what_weighted_edits_bring(model: ColorModel, device: str) -> None:
    """Flips, splits and collapses over a picture with weights: some of each by themselves."""
    mesh, weights = mesh_of_seed(0), random_weights(WIDTH, HEIGHT)
    workspace = poisoned_workspace(
        Device(device, 2), noise(WIDTH, HEIGHT), mesh, model, weights=weights
    )
    appraiser = Appraiser(workspace, LEAST_HEIGHT)
    before = total(appraiser, mesh)
    edges, half_edges = mesh.edge_half_edges, np.arange(3 * mesh.triangle_count)
    flips = np.flatnonzero(flippable(mesh, edges, LEAST_HEIGHT))[::7]
    collapses = half_edges[collapsible(mesh, half_edges, LEAST_HEIGHT)][::11]
    gains, costs = appraiser.flip_gains(edges[flips]), appraiser.collapse_costs(collapses)
    splits = edges[appraiser.split_gains(edges)[0] > -IMPOSSIBLE][::9]
    split_gains, points = appraiser.split_gains(splits)
    flipped = [flip_edges(mesh, [edge]) for edge in edges[flips]]
    collapsed = [collapse_edges(mesh, [half_edge]) for half_edge in collapses]
    split = [split_edges(mesh, [edge], [at]) for edge, at in zip(splits, points, strict=True)]
    for measured, edited in ((gains, flipped), (-costs, collapsed), (split_gains, split)):
        saved = [before - total(appraiser, after) for after in edited]
        np.testing.assert_allclose(measured, saved, **TOLERANCE)


@SEEDS
def test_collapses_that_fold_a_triangle_are_impossible(seed: int, device: str) -> None:
    """Those that leave a thin or an overturned triangle, or pull the border inwards."""
    mesh = mesh_of_seed(seed)
    appraiser = appraiser_of(device, LINEAR, noise(WIDTH, HEIGHT), mesh)
    appraiser.energies(mesh)
    half_edges = np.arange(3 * mesh.triangle_count)
    corners, following = mesh.triangles.reshape(-1), next_corner(half_edges)
    lowest = np.full(len(half_edges), np.inf)
    for half_edge in half_edges:
        origin, goal = corners[half_edge], corners[following[half_edge]]
        around = mesh.triangles[(mesh.triangles == origin).any(axis=1)]
        around = around[~(around == goal).any(axis=1)]
        moved = mesh.vertices[np.where(around == origin, goal, around)]
        lowest[half_edge] = heights_of(moved).min(initial=np.inf)
    folded = appraiser.collapse_costs(half_edges) > 0.5 * IMPOSSIBLE
    assert 20 < folded.sum() < len(half_edges) - 20
    border = (mesh.on_left_right | mesh.on_top_bottom)[corners]
    inwards = border & (mesh.twins >= 0)
    np.testing.assert_array_equal(folded[~inwards], (lowest < LEAST_HEIGHT)[~inwards])
    assert folded[inwards].all()


def test_measuring_a_part_gives_the_same_numbers(device: str) -> None:
    """Any order, any number of changes, and none at all."""
    mesh = mesh_of_seed(0)
    appraiser = appraiser_of(device, LINEAR, noise(WIDTH, HEIGHT), mesh)
    appraiser.energies(mesh)
    splits = (lambda edges, part=part: appraiser.split_gains(edges)[part] for part in (0, 1))
    for measure in (appraiser.flip_gains, appraiser.collapse_costs, *splits):
        edges = mesh.edge_half_edges
        everything = measure(edges)
        order = np.random.default_rng(0).permutation(len(edges))[:17]
        np.testing.assert_array_equal(measure(edges[order]), everything[order])
        assert len(measure(edges[:0])) == 0


def test_appraiser_forgets_a_picture_when_told(device: str) -> None:
    """A mesh is measured once per picture; a larger mesh needs more memory."""
    mesh = mesh_of_seed(0)
    workspace = poisoned_workspace(Device(device), noise(WIDTH, HEIGHT), mesh, LINEAR)
    appraiser = Appraiser(workspace, LEAST_HEIGHT)
    first = appraiser.energies(mesh).copy()
    gains = appraiser.flip_gains(mesh.edge_half_edges)
    large = random_mesh(WIDTH, HEIGHT, 900, seed=5)
    assert len(appraiser.energies(large)) == large.triangle_count
    assert len(appraiser.flip_gains(large.edge_half_edges)) == large.edge_count
    np.testing.assert_array_equal(appraiser.energies(mesh), first)
    np.testing.assert_array_equal(appraiser.flip_gains(mesh.edge_half_edges), gains)
    workspace.load_image(np.zeros((HEIGHT, WIDTH, 3), dtype=np.uint8))
    appraiser.forget()
    np.testing.assert_array_equal(appraiser.energies(mesh), 0.0)


@pytest.mark.parametrize("calm", [False, True])
@MODELS
def test_flips_never_raise_the_energy(model: ColorModel, calm: bool, device: str) -> None:
    """Without a vertex to move and a triangle to add, flips alone are left."""
    mesh = mesh_of_seed(1)
    appraiser = appraiser_of(device, model, waves(WIDTH, HEIGHT), mesh)
    flips_only = Energy(relocated=0.0, calm_relocated=0.0)
    energies = [total(appraiser, mesh)]
    for _ in range(6):
        mesh = flips_only.adapt(mesh, appraiser, Goal(mesh.triangle_count, calm=calm))
        assert_valid(mesh)
        energies.append(total(appraiser, mesh))
    assert (np.diff(energies) <= LEAST_GAIN).all()
    assert energies[-1] < energies[0]


@pytest.mark.parametrize("count", [60, 180, 401])
@pytest.mark.parametrize("name", TOPOLOGIES)
def test_count_is_reached(name: str, count: int, device: str) -> None:
    """After some rounds the number of triangles is the goal's, give or take one."""
    mesh = random_mesh(WIDTH, HEIGHT, 10, seed=3)
    appraiser = appraiser_of(device, COLOR_MODELS["constant"], noise(WIDTH, HEIGHT), mesh)
    for _ in range(10):
        mesh = TOPOLOGIES[name]().adapt(mesh, appraiser, Goal(count))
        assert_valid(mesh)
        assert mesh.triangle_count <= count + 1
    assert abs(mesh.triangle_count - count) <= 1


@MODELS
def test_what_exceeds_the_count_goes(model: ColorModel, device: str) -> None:
    """Triangles are taken away where they are missed least: most of the picture stays."""
    mesh = random_mesh(WIDTH, HEIGHT, 150, seed=3)
    picture = np.zeros((HEIGHT, WIDTH, 3), dtype=np.uint8)
    picture[:, : WIDTH // 2] = noise(WIDTH // 2, HEIGHT)
    appraiser = appraiser_of(device, model, picture, mesh)
    count = mesh.triangle_count * 2 // 3
    for _ in range(10):
        mesh = Energy().adapt(mesh, appraiser, Goal(count))
        assert_valid(mesh)
    assert abs(mesh.triangle_count - count) <= 1
    busy = mesh.vertices[mesh.triangles].mean(axis=1)[:, 0] < WIDTH // 2
    assert busy.mean() > 0.8


def test_too_many_triangles_go_without_a_barred_collapse(device: str) -> None:
    """A bug of the past: collapses barred by the largest area were made where too many stood."""
    mesh = mesh_of_seed(0)
    limit = 1.2 * float(mesh.areas.max())
    appraiser = appraiser_of(device, COLOR_MODELS["constant"], noise(WIDTH, HEIGHT), mesh)
    for _ in range(4):
        mesh = Energy().adapt(mesh, appraiser, Goal(count=8, largest_area=limit))
        assert_valid(mesh)
        assert mesh.areas.max() <= limit * (1 + 1e-9)


@pytest.mark.parametrize("name", TOPOLOGIES)
@pytest.mark.parametrize("wanted", [2, 30, 1500])
def test_growth_ends_where_it_shall(name: str, wanted: int) -> None:
    """From the layout over a peak to the wanted number, without a jump."""
    growth = TOPOLOGIES[name]().growth
    counts = [growth.count(progress, wanted) for progress in np.linspace(0, 1, 200)]
    assert counts[0] == round(growth.start * wanted)
    assert counts[-1] == wanted
    assert max(counts) <= growth.peak * wanted
    assert np.abs(np.diff(counts)).max() <= max(1, 0.05 * wanted * growth.peak)


@pytest.mark.parametrize("name", TOPOLOGIES)
@MODELS
def test_every_topology_keeps_its_contract(model: ColorModel, name: str, device: str) -> None:
    """A frozen dataclass of numbers; valid meshes; the argument and what stays are untouched."""
    topology = TOPOLOGIES[name]()
    assert dataclasses.is_dataclass(topology)
    mesh = mesh_of_seed(0)
    kept = mesh.vertices.copy(), mesh.triangles.copy()
    appraiser = appraiser_of(device, model, waves(WIDTH, HEIGHT), mesh)
    for calm in (False, True):
        for threshold in (None, 4.0):
            goal = Goal(mesh.triangle_count + 30, threshold, calm)
            adapted = topology.adapt(mesh, appraiser, goal)
            again = topology.adapt(mesh, appraiser, goal)
            assert_valid(adapted)
            np.testing.assert_array_equal(adapted.triangles, again.triangles)
            _, old, new = np.intersect1d(mesh.vertex_ids, adapted.vertex_ids, return_indices=True)
            moved = (adapted.vertices[new] != mesh.vertices[old]).any(axis=1)
            border = adapted.on_left_right | adapted.on_top_bottom
            assert border[new[moved]].all()  # pressed onto it
            np.testing.assert_allclose(adapted.vertices[new], mesh.vertices[old], atol=1)
    np.testing.assert_array_equal(mesh.vertices, kept[0])
    np.testing.assert_array_equal(mesh.triangles, kept[1])


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_threshold_nobody_exceeds_splits_nothing(name: str, device: str) -> None:
    """A picture of one colour has no error: no triangle is added."""
    mesh = random_mesh(WIDTH, HEIGHT, 20, seed=6)
    grey = np.full((HEIGHT, WIDTH, 3), 99, dtype=np.uint8)
    appraiser = appraiser_of(device, LINEAR, grey, mesh)
    adapted = TOPOLOGIES[name]().adapt(mesh, appraiser, Goal(10_000, 1.0))
    assert adapted.triangle_count <= mesh.triangle_count


@pytest.mark.parametrize(
    "topology",
    [TOPOLOGIES["delaunay"](), Energy(relocated=0.0, calm_relocated=0.0)],
    ids=["delaunay", "energy"],
)
def test_calm_changes_less(topology: Topology, device: str) -> None:
    """From the same mesh fewer triangles change when a picture is followed; by energies fewer
    flips, for vertices move elsewhere as readily as ever."""
    mesh = mesh_of_seed(0)
    appraiser = appraiser_of(device, LINEAR, waves(WIDTH, HEIGHT), mesh)
    changed = [
        int(_changed(mesh, adapted).sum())
        for adapted in (
            topology.adapt(mesh, appraiser, Goal(mesh.triangle_count, calm=calm))
            for calm in (True, False)
        )
    ]
    assert changed[0] < changed[1]


@SEEDS
def test_delaunay_stays_delaunay(seed: int, device: str) -> None:
    """Whatever was split and collapsed, the whole mesh is Delaunay; calmly a Delaunay one too."""
    mesh = random_mesh(WIDTH, HEIGHT, 40, seed=seed)
    appraiser = appraiser_of(device, LINEAR, waves(WIDTH, HEIGHT), mesh)
    for calm in (False, True):
        goal = Goal(mesh.triangle_count + 20, calm=calm)
        mesh = TOPOLOGIES["delaunay"]().adapt(mesh, appraiser, goal)
        assert_delaunay(mesh)


def _changed(before: Mesh, after: Mesh) -> np.ndarray:
    """Which triangles an edit made or changed, [T] bool."""
    return kept_triangles(before, after) < 0
