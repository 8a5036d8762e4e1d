"""The stage around the meshes: its units, its times, and a camera whose picture is the picture."""

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

from pxr import Gf, Tf, Usd, UsdGeom

from stages.exchange.film import Film
from stages.exchange.solids.viewpoint import METRES, Viewpoint
from stages.exchange.usd.material import add_colors

APERTURE = 360.0
"""Width of the camera's film [tenths of a unit, which is a millimetre]: that of 35 mm."""


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
    add_colors(picture)
    _add_camera(root, film)
    try:
        stage.GetRootLayer().Export(str(path), comment="made by trimotion")
    except Tf.ErrorException as error:  # its text names lines of the library's source, no reason
        raise OSError("usd-core failed") from error


def _add_camera(root: UsdGeom.Xform, film: Film) -> None:
    """A camera whose picture is the picture; with a relief, as large as its highest places are.

    It is no orthographic one, since Blender takes the apertures of those for ten times as large.
    """
    width, height = film.size
    view = Viewpoint.of(film)
    camera = UsdGeom.Camera.Define(root.GetPrim().GetStage(), root.GetPath().AppendChild("camera"))
    camera.AddTranslateOp().Set(Gf.Vec3d(0, 0, view.distance))
    camera.CreateHorizontalApertureAttr(APERTURE)
    camera.CreateVerticalApertureAttr(APERTURE * height / width)
    camera.CreateFocalLengthAttr(APERTURE * view.free / width)
    camera.CreateClippingRangeAttr(Gf.Vec2f(view.near, view.far))
