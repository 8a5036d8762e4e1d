"""Smoothing over time: calm stays calm, noise goes, nothing lags, nothing folds."""

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.envelope import Solved
from pipeline.look.smooth import Smoother, reach_of
from pipeline.options.look import Look
from stages.mesh import Mesh
from stages.motion.correspondence import kept_vertices
from stages.snapshot import Snapshot, with_origins
from stages.validate import assert_valid
from tests.meshes import random_mesh, two_triangles
from tests.snapshots import restless_shot, snapshot_with
from warp_kernels.color_model import CONSTANT, LINEAR, ColorModel
from warp_kernels.errors import OptionError


def smooth(shot: list[Snapshot], sigma: float, first_of_second: int | None = None) -> list:
    """Smooth a shot, or two."""
    smoother, found = Smoother(sigma), []
    for number, snapshot in enumerate(shot):
        second = first_of_second is not None and number >= first_of_second
        found += smoother.add(Solved(int(second), snapshot))
    return [solved.snapshot for solved in [*found, *smoother.rest()]]


def test_few_frames_are_kept() -> None:
    """Those that a smooth frame depends on; memory does not grow with the clip."""
    gc.freeze()  # of all that other tests have left nothing is looked at twenty times
    smoother, given, most = Smoother(0.6), [], 0
    for snapshot in (snapshot_with(two_triangles(), np.zeros((2, 3))) for _ in range(20)):
        given.append(weakref.ref(snapshot))
        for _ in smoother.add(Solved(0, snapshot)):
            pass
        del snapshot
        gc.collect()
        most = max(most, sum(one() is not None for one in given))
    assert most <= 2 * reach_of(0.6) + 1


def paths(shot: list[Snapshot]) -> np.ndarray:
    """Positions over time, [frames, V, 2]."""
    return np.stack([snapshot.mesh.vertices for snapshot in shot])


def shaken(mesh: Mesh, count: int, strength: float, seed: int) -> list[Snapshot]:
    """A shot whose inner vertices and colours tremble."""
    rng = np.random.default_rng(seed)
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    shot = []
    for index in range(count):
        step = strength * rng.standard_normal(mesh.vertices.shape) * inner[:, None]
        moved = mesh.moved(mesh.vertices + step)
        folded = moved.areas <= 0
        keep = np.unique(mesh.triangles[folded]) if folded.any() else []
        while len(keep):
            step[keep] = 0.0
            moved = mesh.moved(mesh.vertices + step)
            keep = np.unique(mesh.triangles[moved.areas <= 0])
        shot.append(snapshot_with(moved, 128 + 20 * rng.standard_normal((len(folded), 3)), index))
    return shot


@pytest.mark.parametrize("model", [CONSTANT, LINEAR])
def test_what_stands_still_stays(model: ColorModel) -> None:
    """To the bit, positions and colours; with sigma 0 everything does."""
    mesh = random_mesh(1)
    colors = np.random.default_rng(0).random((mesh.triangle_count, 3, model.term_count))
    shot = [snapshot_with(mesh, colors, n, model) for n in range(7)]
    for snapshot in smooth(shot, 1.5):
        np.testing.assert_array_equal(snapshot.mesh.vertices, mesh.vertices)
        np.testing.assert_allclose(snapshot.coefficients, colors, rtol=0, atol=1e-11)
        if model is CONSTANT:
            np.testing.assert_array_equal(snapshot.coefficients, colors)
    restless = restless_shot(mesh, 3)
    assert all(one is other for one, other in zip(smooth(restless, 0.0), restless, strict=True))


def test_even_motion_stays() -> None:
    """No lag, at the first and last frames neither."""
    mesh = random_mesh(2)
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    shot = [
        snapshot_with(
            mesh.moved(mesh.vertices + 1e-3 * n * inner[:, None]),
            np.ones((len(mesh.triangles), 3)) * n,
            n,
        )
        for n in range(9)
    ]
    found = smooth(shot, 1.0)
    np.testing.assert_allclose(paths(found), paths(shot), rtol=0, atol=1e-12)
    for one, other in zip(found, shot, strict=True):
        np.testing.assert_allclose(one.coefficients, other.coefficients, rtol=0, atol=1e-12)


def test_noise_becomes_less() -> None:
    """Of paths and of colours, by its second difference; and more with a larger sigma."""
    shot = shaken(random_mesh(3), 24, 0.05, 0)
    jitter = [np.abs(np.diff(paths(smooth(shot, s)), 2, axis=0))[4:-4].mean() for s in (0, 1, 2)]
    assert jitter[1] < 0.35 * jitter[0]
    assert jitter[2] < 0.5 * jitter[1]
    colors = [np.stack([s.coefficients for s in smooth(shot, sigma)]) for sigma in (0.0, 1.0)]
    flicker = [np.abs(np.diff(each, axis=0))[4:-4].mean() for each in colors]
    assert flicker[1] < 0.5 * flicker[0]


def test_backwards_is_the_same() -> None:
    """A film that runs backwards gives the same frames, to the bit, edits included."""
    shot = restless_shot(random_mesh(4), 9)
    forwards, backwards = smooth(shot, 1.0), smooth(shot[::-1], 1.0)[::-1]
    for one, other in zip(forwards, backwards, strict=True):
        np.testing.assert_array_equal(one.mesh.vertices, other.mesh.vertices)
        np.testing.assert_array_equal(one.coefficients, other.coefficients)


def test_shots_and_lives_are_apart() -> None:
    """What is born is where it was born; a cut lets nothing through."""
    shot = restless_shot(random_mesh(5), 8)
    for one, other, before in zip(smooth(shot, 1.0)[1:], shot[1:], shot, strict=False):
        born = kept_vertices(before.mesh, other.mesh) < 0
        assert born.any()
        np.testing.assert_array_equal(one.mesh.vertices[born], other.mesh.vertices[born])
    both = smooth(shot, 1.0, first_of_second=3)
    for part, alone in ((both[:3], shot[:3]), (both[3:], shot[3:])):
        np.testing.assert_array_equal(part[1].mesh.vertices, smooth(alone, 1.0)[1].mesh.vertices)


@settings(max_examples=25)
@given(st.integers(0, 10_000), st.floats(0.1, 30.0), st.floats(0.4, 4.0))
def test_nothing_folds(seed: int, strength: float, sigma: float) -> None:
    """However wild the motion; borders and corners stay."""
    mesh = random_mesh(seed, inner=12)
    shot = shaken(mesh, 7, strength, seed)
    for snapshot, source in zip(smooth(shot, sigma), shot, strict=True):
        if source.mesh.heights.min() > 1e-3:
            assert_valid(snapshot.mesh)
        assert snapshot.mesh.areas.min() > 0
        rim = mesh.on_left_right | mesh.on_top_bottom
        np.testing.assert_array_equal(snapshot.mesh.vertices[rim], mesh.vertices[rim])


def test_border_vertices_slide_along() -> None:
    """One on the border that trembles along it is smoothed along it."""
    square = two_triangles()
    points = np.concatenate([square.vertices, [[2.0, 0.0]]])
    mesh = replace(
        square,
        vertices=points,
        triangles=[[0, 4, 3], [4, 1, 3], [1, 2, 3]],
        vertex_ids=np.arange(5),
        triangle_ids=np.arange(3),
    )
    shot = []
    for n in range(9):
        points[4, 0] = 2.0 + 0.5 * (-1) ** n
        shot.append(snapshot_with(mesh.moved(points), np.ones((3, 3)), n))
    found = paths(smooth(shot, 1.0))[3:-3, 4]
    assert (found[:, 1] == 0).all()
    assert np.abs(found[:, 0] - 2.0).max() < 0.1


def test_polynomials_move_to_other_origins(rng: np.random.Generator) -> None:
    """Their values stay."""
    for model in (CONSTANT, LINEAR, ColorModel("quadratic", degree=2)):
        coefficients = rng.standard_normal((5, 3, model.term_count))
        origins, points = rng.standard_normal((2, 5, 2))

        def values(coefficients: np.ndarray, at: np.ndarray, model: ColorModel) -> np.ndarray:
            """Of each triangle's polynomial at a point of its own, [5, 3]."""
            terms = np.prod(at[:, None, :] ** np.array(model.exponents), axis=2)
            return np.einsum("tck,tk->tc", coefficients, terms)

        moved = with_origins(model, coefficients, origins)
        expected = values(coefficients, points, model)
        np.testing.assert_allclose(values(moved, points - origins, model), expected, atol=1e-9)


@pytest.mark.parametrize("option", [{"smooth": -1.0}, {"smooth": 51.0}, {"blend": -1}])
def test_impossible_values_are_refused(option: dict) -> None:
    """The message names the option and the limits."""
    with pytest.raises(OptionError, match=r"--(smooth|blend) .* between 0 \(off\) and"):
        Look(**option)
