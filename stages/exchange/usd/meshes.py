"""Meshes of USD: what frames of one topology share, and what of it is seen when."""

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, Vt

from stages.exchange.solids.runs import MeshPose, MeshRun

ALWAYS = Usd.TimeCode.Default()
"""The value of what never changes, and for programs that play nothing."""
STEP = Usd.TimeCode.SafeStep()
"""Right before a frame [frames]: what is told there holds up to it, where else programs would go
straight to the next value."""


def add_runs(
    parent: UsdGeom.Xform, runs: list[MeshRun], times: list[float] | None, is_flat: bool
) -> None:
    """One mesh for each run; it is seen from its first frame to that of the next one.

    Args:
        parent: What the meshes belong to.
        runs: The runs.
        times: When each frame is shown [frames]; None for a still.
        is_flat: Whether a triangle has one colour, or one at each corner.
    """
    place = 0
    for run in runs:
        mesh = _mesh_below(parent, run.name, is_flat)
        _tell_corners(mesh, run.triangles, ALWAYS)
        _tell_pose(mesh, run.poses[0], ALWAYS)
        if times is not None:
            own = times[place : place + len(run.poses)]
            if len(own) > 1:
                for pose, time in zip(run.poses, own, strict=True):
                    _tell_pose(mesh, pose, time)
            place += len(own)
            _tell_life(mesh, own[0], times[0], times[place] if place < len(times) else None)


def add_one_mesh(
    parent: UsdGeom.Xform, runs: list[MeshRun], times: list[float] | None, is_flat: bool
) -> None:
    """One mesh for all, whose corners change in time.

    Programs go straight between two samples of as many points, whatever the corners are. So where a
    run ends its last pose is told once more, right before the next run begins.

    Args:
        parent: What the mesh belongs to.
        runs: The runs.
        times: When each frame is shown [frames]; None for a still.
        is_flat: Whether a triangle has one colour, or one at each corner.
    """
    mesh = _mesh_below(parent, "mesh", is_flat)
    _tell_corners(mesh, runs[0].triangles, ALWAYS)
    _tell_pose(mesh, runs[0].poses[0], ALWAYS)
    if times is None:
        return
    place = 0
    for run in runs:
        own = times[place : place + len(run.poses)]
        place += len(own)
        if len(runs) > 1:
            _tell_corners(mesh, run.triangles, own[0])
        for pose, time in zip(run.poses, own, strict=True):
            _tell_pose(mesh, pose, time)
        if place < len(times):
            _tell_pose(mesh, run.poses[-1], times[place] - STEP)


def _mesh_below(parent: UsdGeom.Xform, name: str, is_flat: bool) -> UsdGeom.Mesh:
    path = parent.GetPath().AppendChild(name)
    mesh = UsdGeom.Mesh.Define(parent.GetPrim().GetStage(), path)
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    mesh.CreateDoubleSidedAttr(True)
    for_each = UsdGeom.Tokens.uniform if is_flat else UsdGeom.Tokens.faceVarying
    UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(
        UsdGeom.Tokens.primvarsDisplayColor, Sdf.ValueTypeNames.Color3fArray, for_each
    )
    return mesh


def _tell_corners(mesh: UsdGeom.Mesh, triangles: np.ndarray, time: Usd.TimeCode | float) -> None:
    counts = np.full(len(triangles), 3, np.int32)
    mesh.GetFaceVertexCountsAttr().Set(Vt.IntArray.FromNumpy(counts), time)
    corners = np.ascontiguousarray(triangles, np.int32).ravel()
    mesh.GetFaceVertexIndicesAttr().Set(Vt.IntArray.FromNumpy(corners), time)


def _tell_pose(mesh: UsdGeom.Mesh, pose: MeshPose, time: Usd.TimeCode | float) -> None:
    mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(pose.points), time)
    mesh.GetDisplayColorAttr().Set(Vt.Vec3fArray.FromNumpy(pose.colors), time)
    edges = np.stack([pose.points.min(axis=0), pose.points.max(axis=0)])
    mesh.GetExtentAttr().Set(Vt.Vec3fArray.FromNumpy(edges), time)


def _tell_life(mesh: UsdGeom.Mesh, begin: float, start: float, end: float | None) -> None:
    """Show a mesh in its time only: by its visibility, and by a scale of 0 for programs, such as
    Blender, that do not play that.

    Args:
        mesh: The mesh.
        begin: Its first frame.
        start: The first one of the clip; what is told of it holds before, too.
        end: The first one of the next mesh, or None.
    """
    shown, scale = mesh.CreateVisibilityAttr(), mesh.AddScaleOp()

    def _show(seen: bool, time: Usd.TimeCode | float) -> None:
        shown.Set(UsdGeom.Tokens.inherited if seen else UsdGeom.Tokens.invisible, time)
        scale.Set(Gf.Vec3f(seen), time)

    _show(begin == start, ALWAYS)
    if begin > start:
        _show(False, start)
        _show(False, begin - STEP)
    _show(True, begin)
    if end is not None:
        _show(True, end - STEP)
        _show(False, end)
