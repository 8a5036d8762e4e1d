"""Pictures, meshes of any size, poisoned workspaces and snapshots for the tests of the kernels."""

from fractions import Fraction
from typing import Any

import numpy as np
import warp as wp
from scipy.spatial import Delaunay

from stages.frame import Frame
from stages.mesh import Mesh, areas_of, mesh_of
from stages.optimize import load_mesh
from stages.snapshot import Snapshot
from stages.validate import assert_valid
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device
from warp_kernels.energy.workspace import Workspace

POISON = 77
"""What arrays hold before anything is written to them; fits every type."""


class PoisonedWorkspace(Workspace):
    """A workspace whose memory holds nonsense at first: what is not written shows."""

    def _empty(self, shape: Any, dtype: Any) -> wp.array:
        array = super()._empty(shape, dtype)
        array.fill_(POISON)
        return array


def noise(width: int, height: int, seed: int = 0) -> np.ndarray:
    """A picture of independent code values, [H, W, 3] uint8."""
    return np.random.default_rng(seed).integers(0, 256, (height, width, 3), dtype=np.uint8)


def random_weights(width: int, height: int, seed: int = 0) -> np.ndarray:
    """Independent weights from 1 to 255 without a common divisor, [H, W] uint8."""
    weights = np.random.default_rng(seed).integers(1, 256, (height, width), dtype=np.uint8)
    weights[0, 0] = 1
    return weights


def waves(width: int, height: int) -> np.ndarray:
    """A picture of soft waves and one bright disc with a sharp outline, [H, W, 3] uint8."""
    y, x = np.mgrid[:height, :width] + 0.5
    u, v = x / width, y / height
    soft = [np.sin(7 * u + 3 * v + 2 * c) * np.cos(5 * v - 2 * u) for c in range(3)]
    picture = 128 + 90 * np.stack(soft, axis=2)
    picture[(u - 0.6) ** 2 + (v - 0.45) ** 2 < 0.05] = (245, 225, 60)
    return picture.astype(np.uint8)


def random_mesh(
    width: int, height: int, inner: int, *, seed: int = 0, border: int = 6, grid: int = 0
) -> Mesh:
    """A Delaunay mesh of random points.

    Args:
        width: Width of the picture [px].
        height: Height of the picture [px].
        inner: Number of inner points.
        seed: Seed of the points.
        border: Number of points along the border beside the corners.
        grid: Round positions to 1 / grid px; 0 leaves them as they are.
    """
    rng = np.random.default_rng(seed)
    size = np.array([width, height])
    corners = np.array([[0, 0], [width, 0], [0, height], [width, height]])
    points = rng.random((border + inner, 2)) * size
    axis = rng.integers(2, size=border)
    points[np.arange(border), axis] = size[axis] * rng.integers(2, size=border)
    if grid:
        points = np.round(points * grid) / grid
    return delaunay_mesh(np.concatenate([corners, points]), width, height)


def delaunay_mesh(points: np.ndarray, width: int, height: int) -> Mesh:
    """A valid Delaunay mesh of points [px, V x 2] that contain the corners."""
    points = np.unique(points, axis=0)
    rows = Delaunay(points).simplices
    mesh = mesh_of(points, rows[areas_of(points[rows]) != 0], width, height)
    assert_valid(mesh)
    return mesh


def frame_of(picture: np.ndarray, index: int = 0) -> Frame:
    """A picture [H, W, 3] as a frame of a clip of 25 frames per second."""
    return Frame(index, index, Fraction(1, 25), picture)


def poisoned_workspace(
    device: Device,
    picture: np.ndarray,
    mesh: Mesh,
    model: ColorModel,
    sums: str = "edges",
    weights: np.ndarray | None = None,
) -> Workspace:
    """A workspace with a picture and a mesh in it; its memory held nonsense before."""
    size = (picture.shape[1], picture.shape[0])
    workspace = PoisonedWorkspace(device, size, model, sums, weighted=weights is not None)
    workspace.load_image(picture, weights)
    load_mesh(workspace, mesh)
    return workspace


def snapshot_of(device: Device, picture: np.ndarray, mesh: Mesh, model: ColorModel) -> Snapshot:
    """The best colours of a mesh over a picture."""
    coefficients, energies, counts = poisoned_workspace(device, picture, mesh, model).fit()
    return Snapshot(0, 0, Fraction(1, 25), mesh, model, coefficients, energies, counts)
