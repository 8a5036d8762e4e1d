"""USD: what a program sees at and between frames is what was solved, to the bit of float32."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stages.exchange.figure import Figure
from stages.exchange.solids.linear_light import linear_light
from tests.films import RATE, figures_of, film_of, format_with, graded_figures, mixed_figures
from tests.meshes import HEIGHT, WIDTH, two_triangles
from tests.snapshots import snapshot_with

Usd = pytest.importorskip("pxr.Usd", reason="pip install usd-core")
UsdGeom = pytest.importorskip("pxr.UsdGeom")

WITHOUT = """
import sys
sys.modules["pxr"] = None
from stages.exchange import format_of
from tests.films import film_of
format_of("a.usdc").check(film_of(".usdc"))
"""


def written(path: Path, figures: list[Figure], style: str = "flat", **options: Any) -> Path:
    format_with(film_of(path.suffix, style, **options), figures).save(path)
    return path


def seen_at(stage: Any, time: float) -> list[tuple[np.ndarray, ...]]:
    """Positions and colours of the corners of every mesh that is seen, triangle by triangle.

    What is hidden has no size either.
    """
    found = []
    for prim in stage.Traverse():
        if not prim.IsA(UsdGeom.Mesh):
            continue
        mesh = UsdGeom.Mesh(prim)
        is_seen = mesh.ComputeVisibility(time) != "invisible"
        size = np.array(mesh.GetLocalTransformation(time))
        np.testing.assert_array_equal(size, np.diag([is_seen, is_seen, is_seen, 1]))
        if not is_seen:
            continue
        corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(time)).reshape(-1, 3)
        assert set(mesh.GetFaceVertexCountsAttr().Get(time)) == {3}
        points = np.array(mesh.GetPointsAttr().Get(time))[corners]
        colors = np.array(mesh.GetDisplayColorAttr().Get(time))
        is_flat = mesh.GetDisplayColorPrimvar().GetInterpolation() == "uniform"
        colors = np.repeat(colors[:, None], 3, 1) if is_flat else colors.reshape(-1, 3, 3)
        assert colors.shape == points.shape
        low, high = np.array(mesh.GetExtentAttr().Get(time))
        assert (points >= low).all()
        assert (points <= high).all()
        found.append((points, colors))
    return found


def wanted(figure: Figure) -> tuple[np.ndarray, np.ndarray]:
    corners = figure.mesh.corners[:, [0, 2, 1]]
    points = np.dstack([corners[..., 0], HEIGHT - corners[..., 1], 0 * corners[..., 0]])
    colors = np.repeat(linear_light(figure.colors)[:, None], 3, axis=1)
    return points.astype(np.float32), colors


@pytest.mark.parametrize("single", [False, True], ids=["runs", "single"])
@pytest.mark.parametrize("ending", [".usd", ".usda", ".usdc"])
def test_every_frame_is_seen_alone_at_and_between_samples(
    tmp_path: Path, ending: str, single: bool
) -> None:
    figures = mixed_figures()
    stage = Usd.Stage.Open(str(written(tmp_path / f"a{ending}", figures, usd_single=single)))
    meshes = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    assert len(meshes) == (1 if single else 4)
    for number, figure in enumerate(figures):
        time = float(figure.time * RATE)
        (seen,) = seen_at(stage, time)
        for found, right in zip(seen, wanted(figure), strict=True):
            np.testing.assert_array_equal(found, right)
        if number:
            (soon,) = seen_at(stage, time - 1e-6)
            assert len(soon[0]) == len(wanted(figures[number - 1])[0])
        (late,) = seen_at(stage, time + 0.5)
        goes_on = number < 2  # the first three frames have one topology
        after = wanted(figures[number + goes_on])
        for found, now, then in zip(late, wanted(figure), after, strict=True):
            np.testing.assert_allclose(found, (now + then) / 2, atol=1e-4)
    for time in (-7.0, 999.0):
        (seen,) = seen_at(stage, time)
        figure = figures[0 if time < 0 else -1]
        np.testing.assert_array_equal(seen[0], wanted(figure)[0])


def test_programs_that_play_nothing_show_the_first_frame(tmp_path: Path) -> None:
    figures = mixed_figures()
    for single in (False, True):
        stage = Usd.Stage.Open(
            str(written(tmp_path / f"{single}.usdc", figures, usd_single=single))
        )
        (seen,) = seen_at(stage, Usd.TimeCode.Default())
        np.testing.assert_array_equal(seen[0], wanted(figures[0])[0])
    still = figures_of([snapshot_with(two_triangles(), np.full((2, 3), 9))])
    stage = Usd.Stage.Open(str(written(tmp_path / "still.usd", still)))
    assert not stage.HasAuthoredTimeCodeRange()
    attributes = [one for prim in stage.Traverse() for one in prim.GetAttributes()]
    assert not any(one.GetNumTimeSamples() for one in attributes)
    (seen,) = seen_at(stage, Usd.TimeCode.Default())
    np.testing.assert_array_equal(seen[1], wanted(still[0])[1])


def test_gradients_have_the_colours_of_their_corners(tmp_path: Path) -> None:
    figures = graded_figures()
    stage = Usd.Stage.Open(str(written(tmp_path / "a.usdc", figures, "gradient")))
    ((_, colors),) = seen_at(stage, 1)
    coefficients = figures[1].snapshot.coefficients
    corners = figures[1].mesh.corners[:, [0, 2, 1]]
    x, y = corners[..., 0], corners[..., 1]
    terms = np.stack([x**a * y**b for a, b in figures[1].snapshot.model.exponents], 2)
    codes = np.clip(np.einsum("tnk,tck->tnc", terms, coefficients), 0, 255)
    np.testing.assert_allclose(colors, linear_light(codes), atol=1e-6)


@pytest.mark.parametrize("relief", [None, "0.5", "-3"])
def test_the_camera_s_picture_is_the_picture(tmp_path: Path, relief: str | None) -> None:
    figures = mixed_figures()
    stage = Usd.Stage.Open(str(written(tmp_path / "a.usdc", figures, relief=relief)))
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    assert UsdGeom.GetStageMetersPerUnit(stage) == 0.001
    assert (stage.GetTimeCodesPerSecond(), stage.GetFramesPerSecond()) == (25, 25)
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, len(figures) - 1)
    (camera,) = (UsdGeom.Camera(p) for p in stage.Traverse() if p.IsA(UsdGeom.Camera))
    frustum = camera.GetCamera(0).frustum
    matrix = np.array(frustum.ComputeViewMatrix() * frustum.ComputeProjectionMatrix())
    (mesh, *_) = (UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh))
    points = np.array(mesh.GetPointsAttr().Get(0))
    world = np.array(mesh.ComputeLocalToWorldTransform(0))
    for height in {points[:, 2].min(), points[:, 2].max()}:
        placed = np.c_[points[:, :2], np.full_like(points[:, 2], height), np.ones(len(points))]
        shown = placed @ world @ matrix
        shown = shown[:, :3] / shown[:, 3:]
        assert (abs(shown) <= 1 + 1e-6).all()
        if relief is None:
            np.testing.assert_allclose(shown[:, 0], points[:, 0] / WIDTH * 2 - 1, atol=1e-5)
            np.testing.assert_allclose(shown[:, 1], points[:, 1] / HEIGHT * 2 - 1, atol=1e-5)


@pytest.mark.parametrize("options", [{}, {"usd_single": True}, {"relief": "1"}], ids=str)
def test_validators_of_usd_find_nothing(tmp_path: Path, options: dict[str, Any]) -> None:
    validation = pytest.importorskip("pxr.UsdValidation")
    path = written(tmp_path / "a.usdc", mixed_figures(), **options)
    validators = validation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 20
    errors = validation.ValidationContext(validators).Validate(Usd.Stage.Open(str(path)))
    assert [error.GetErrorAsString() for error in errors] == []
    nothing_told = Usd.Stage.CreateInMemory()
    UsdGeom.Mesh.Define(nothing_told, "/mesh")
    assert validation.ValidationContext(validators).Validate(nothing_told)


def test_times_rounded_by_a_file_are_whole_frames(tmp_path: Path) -> None:
    snapshots = [snapshot_with(two_triangles(), np.full((2, 3), n), n) for n in range(4)]
    rounded = [
        Figure(one.snapshot, one.shot, one.time + off, one.paint)
        for one, off in zip(figures_of(snapshots), (0, 0.001, -0.001, 0.001), strict=True)
    ]
    for figures, codes in ((rounded, [0, 1, 2, 3]), (rounded[::2], [0, 2])):
        stage = Usd.Stage.Open(str(written(tmp_path / f"{len(figures)}.usda", figures)))
        (mesh,) = (UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh))
        assert mesh.GetDisplayColorAttr().GetTimeSamples() == codes


def test_a_missing_library_is_told_before_any_work() -> None:
    said = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True)
    last = said.stderr.strip().splitlines()[-1]
    assert "OptionError: .usdc: needs the package usd-core; pip install 'trimotion[usd]'" in last
