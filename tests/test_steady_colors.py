"""Colours of a followed picture do not tremble, and cost next to nothing for it."""

from dataclasses import replace

import numpy as np
import pytest

from stages.edits import flip_edges, flippable, independent_flips
from stages.layouts.importance import Importance
from stages.motion.advect import Carried
from stages.motion.correspondence import kept_triangles
from stages.snapshot import Snapshot
from stages.solve.steady_colors import ALLOWANCE, WELCOME, steadied
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from tests.kernel_samples import frame_of, random_mesh, snapshot_of, waves
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device

SIZE = 64


@pytest.fixture(scope="module")
def before() -> Snapshot:
    """A picture with constant colours."""
    picture = waves(SIZE, SIZE)
    return snapshot_of(
        Device("cpu"), picture, random_mesh(SIZE, SIZE, 40), COLOR_MODELS["constant"]
    )


def moved(before: Snapshot, by: float) -> tuple[np.ndarray, np.ndarray]:
    """What the next frame keeps of colours whose best ones differ by so much."""
    best = before.coefficients + by
    return steadied(before, before.mesh, before.counts, best, before.energies)


def test_small_changes_are_not_shown(before: Snapshot) -> None:
    """A colour stays where it was if that costs no more than is allowed."""
    colors, energies = moved(before, 1e-3)
    torn = before.energies > before.counts * 1e-2
    assert torn.any()
    np.testing.assert_allclose(colors[torn], before.coefficients[torn], atol=1e-9)
    assert (energies >= before.energies).all()


@pytest.mark.parametrize("by", [0.1, 1.0, 5.0, 100.0])
def test_no_colour_costs_more_than_is_allowed(before: Snapshot, by: float) -> None:
    """However far a colour has gone; and what it costs is what is told."""
    colors, energies = moved(before, by)
    assert (energies <= (1 + ALLOWANCE) * before.energies + 1e-6).all()
    away = np.square(colors - before.coefficients - by).sum(axis=(1, 2))
    np.testing.assert_allclose(energies - before.energies, 0.5 * before.counts * away, atol=1e-6)


def test_what_is_flat_follows_at_once(before: Snapshot) -> None:
    """Triangles without an error have nothing to give."""
    flat = replace(before, energies=np.zeros_like(before.energies))
    best = before.coefficients + 1.0
    colors, energies = steadied(flat, flat.mesh, flat.counts, best, flat.energies)
    np.testing.assert_array_equal(colors, best)
    assert not energies.any()


def test_new_triangles_come_from_what_lay_there(before: Snapshot) -> None:
    """What a flip makes goes towards the colours beneath it, for no more than it may cost; and if
    these are the best colours it has them at once."""
    mesh = before.mesh
    edges = mesh.edge_half_edges
    edges = edges[flippable(mesh, edges)]
    flipped = flip_edges(mesh, edges[independent_flips(mesh, edges)][:3])
    born = np.flatnonzero(kept_triangles(mesh, flipped) < 0)
    assert len(born) == 6
    one = replace(before, coefficients=np.full_like(before.coefficients, 90.0))
    for best, is_far in ((90.0, False), (130.0, True)):
        colors, energies = steadied(
            one, flipped, before.counts, np.full_like(before.coefficients, best), before.energies
        )
        allowed = np.full(mesh.triangle_count, ALLOWANCE)
        allowed[born] = WELCOME
        assert (energies <= (1 + allowed) * before.energies + 1e-6).all()
        fitting = born[before.energies[born] > 1.0]
        assert (colors[fitting] < 130.0).all()
        if is_far:
            spent = energies[fitting] / before.energies[fitting] - 1
            np.testing.assert_allclose(spent, WELCOME, rtol=1e-6)
        else:
            np.testing.assert_allclose(colors, 90.0)


@pytest.mark.parametrize("color", ["constant", "linear"])
def test_a_followed_frame_is_steadied(color: str) -> None:
    """Colours of a frame under a breath of noise stay, those of more terms are the best ones."""
    rng = np.random.default_rng(3)
    pictures = [waves(SIZE, SIZE)] * 2
    pictures[1] = np.clip(pictures[1] + rng.integers(-2, 3, pictures[1].shape), 0, 255)
    frames = [frame_of(picture.astype(np.uint8)) for picture in pictures]
    options = TriangulateOptions(
        color=color, iterations=16, frame_iterations=0, refine=RefineOptions(triangles=60)
    )
    triangulator = Triangulator(Device("cpu"), (SIZE, SIZE), options)
    first = triangulator.first(frames[0], Importance(), rng)
    seed = Carried(first.mesh, np.ones(first.mesh.vertex_count, np.float32))
    best, kept = (triangulator.next(frames[1], seed, known) for known in (None, first))
    np.testing.assert_array_equal(best.mesh.vertices, kept.mesh.vertices)
    if color == "linear":
        np.testing.assert_array_equal(best.coefficients, kept.coefficients)
        return
    changes = [np.abs(one.coefficients - first.coefficients).mean() for one in (best, kept)]
    assert changes[1] < changes[0]
    assert kept.rmse <= best.rmse * (1 + 0.5 * WELCOME)
