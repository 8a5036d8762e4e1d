"""The stage around the meshes: its units, its times, and a camera whose picture is the picture."""

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

from pxr import Gf, Tf, Usd, UsdGeom

from stages.exchange.film import Film
from stages.exchange.solids.viewpoint import METRES, Viewpoint

TENTHS = 10
"""Apertures of cameras are told in tenths of a unit."""


def saved_scene(
    path: Path,
    film: Film,
    times: list[float] | None,
    add_meshes: Callable[[UsdGeom.Xform], None],
) -> None:
    """Write a stage.

    Args:
        path: The file; its ending chooses text or binary.
        film: Gives its name, size and rate.
        times: When each frame is shown [frames]; None for a still.
        add_meshes: Adds the meshes below a prim that has the picture's centre in the middle.

    Raises:
        OSError: If it cannot be written.
    """
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, METRES)
    if times is not None:
        rate = float(film.rate or Fraction(25))
        stage.SetTimeCodesPerSecond(rate)
        stage.SetFramesPerSecond(rate)
        stage.SetStartTimeCode(times[0])
        stage.SetEndTimeCode(times[-1])
    root = UsdGeom.Xform.Define(stage, f"/{Tf.MakeValidIdentifier(film.name)}")
    stage.SetDefaultPrim(root.GetPrim())
    width, height = film.size
    picture = UsdGeom.Xform.Define(stage, root.GetPath().AppendChild("picture"))
    picture.AddTranslateOp().Set(Gf.Vec3d(-width / 2, -height / 2, 0))
    add_meshes(picture)
    _add_camera(root, film)
    try:
        stage.GetRootLayer().Export(str(path), comment="made by trimotion")
    except Tf.ErrorException as error:  # its text names lines of the library's source, no reason
        raise OSError("usd-core failed") from error


def _add_camera(root: UsdGeom.Xform, film: Film) -> None:
    width, height = film.size
    view = Viewpoint.of(film)
    camera = UsdGeom.Camera.Define(root.GetPrim().GetStage(), root.GetPath().AppendChild("camera"))
    camera.AddTranslateOp().Set(Gf.Vec3d(0, 0, view.distance))
    camera.CreateProjectionAttr(UsdGeom.Tokens.orthographic)
    camera.CreateHorizontalApertureAttr(TENTHS * width)
    camera.CreateVerticalApertureAttr(TENTHS * height)
    camera.CreateClippingRangeAttr(Gf.Vec2f(view.near, view.far))
