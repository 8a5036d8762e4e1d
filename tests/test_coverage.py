"""Every pixel lies in exactly one triangle, the one that exact arithmetic says."""

import numpy as np
import pytest
import warp as wp

from stages.layouts.grid import Grid
from stages.mesh import Mesh
from tests.kernel_samples import delaunay_mesh, noise, random_mesh, snapshot_of
from tests.oracles.coverage import covered_pixels, rounded
from warp_kernels.color_model import CONSTANT
from warp_kernels.device.device import Device
from warp_kernels.drawing.band_lists import BandLists
from warp_kernels.drawing.gbuffer import fill_threads, record_gbuffer

NOBODY = -1


def grid_mesh(width: int, height: int, triangles: int) -> Mesh:
    """A regular mesh; its vertices lie on whole pixels or between."""
    picture = np.zeros((height, width, 3), dtype=np.uint8)
    return Grid().build(picture, triangles, np.random.default_rng(0))


def needles(width: int, height: int, seed: int = 0) -> Mesh:
    """Long triangles a few hundredths of a pixel thin: points along slanted lines."""
    rng = np.random.default_rng(seed)
    along = rng.random((2, 40))
    x = width * (0.02 + 0.96 * along)
    y = np.stack([height * (0.1 + 0.7 * along[0]), height * (0.6 - 0.3 * along[1])])
    y += rng.integers(-6, 7, y.shape) / 256
    points = np.round(np.stack([x.ravel(), y.ravel()], axis=1) * 256) / 256
    corners = [[0, 0], [width, 0], [0, height], [width, height]]
    return delaunay_mesh(np.concatenate([corners, points]), width, height)


MESHES = {
    "random": lambda: random_mesh(61, 47, 60, seed=1),
    "many_small": lambda: random_mesh(33, 29, 500, seed=2),
    "pixel_centres": lambda: random_mesh(31, 23, 80, seed=3, grid=2),
    "pixel_corners": lambda: random_mesh(31, 23, 80, seed=4, grid=1),
    "fixed_points": lambda: random_mesh(17, 64, 40, seed=5, grid=256),
    "needles": lambda: needles(97, 64),
    "grid": lambda: grid_mesh(40, 25, 64),
    "one_pixel": lambda: grid_mesh(1, 1, 2),
    "one_pixel_random": lambda: random_mesh(1, 1, 9, seed=6),
    "two_by_two": lambda: random_mesh(2, 2, 7, seed=7),
    "three_by_two": lambda: random_mesh(3, 2, 7, seed=8, grid=2),
    "tall": lambda: random_mesh(2, 720, 40, seed=9),
    "wide": lambda: random_mesh(720, 2, 40, seed=10),
}


def owners_by_oracle(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """The triangle of every pixel [H, W] and how often each is covered [H, W]."""
    owners = np.full((mesh.height, mesh.width), NOBODY)
    times = np.zeros_like(owners)
    for number, corners in enumerate(mesh.vertices[mesh.triangles].tolist()):
        triangle = [rounded(x, y) for x, y in corners]
        sign, pixels = covered_pixels(triangle, mesh.width, mesh.height)
        for column, row in pixels:
            owners[row, column] = number
            times[row, column] += sign
    return owners, times


def owners_by_kernel(mesh: Mesh, device: Device) -> np.ndarray:
    """The triangle of every pixel as the renderer sees it, in two bands, [H, W]."""
    cut = mesh.height // 2
    bands = []
    lists = BandLists(device, mesh.height, mesh.height)
    lists.write(mesh.vertices, mesh.triangles, 1.0)
    for first_row, rows in ((0, cut), (cut, mesh.height - cut)):
        band = wp.full((rows, mesh.width), NOBODY, dtype=int, device=device.warp)
        phase = record_gbuffer(
            device,
            vertices=wp.array(mesh.vertices, dtype=wp.vec2d, device=device.warp),
            triangles=wp.array(mesh.triangles, dtype=wp.vec3i, device=device.warp),
            lists=lists,
            band=0,
            scale=(1.0, 1.0),
            first_row=first_row,
            samples=1,
            triangle_out=band,
        )
        phase.resize(rows, threads=fill_threads(device, mesh.triangle_count))
        device.run([phase])
        bands.append(band.numpy())
    return np.concatenate(bands)


@pytest.mark.parametrize("name", MESHES)
def test_every_pixel_lies_in_one_triangle(name: str, device: str) -> None:
    """Oracle, drawn triangles and counted pixels agree, and nobody is left out or twice in."""
    mesh = MESHES[name]()
    owners, times = owners_by_oracle(mesh)
    assert (times == 1).all()
    np.testing.assert_array_equal(owners_by_kernel(mesh, Device(device)), owners)
    snapshot = snapshot_of(Device(device), noise(mesh.width, mesh.height), mesh, CONSTANT)
    expected = np.bincount(owners.ravel(), minlength=mesh.triangle_count)
    np.testing.assert_array_equal(snapshot.counts, expected)


@pytest.mark.parametrize("seed", range(4))
def test_rounding_leaves_no_gap(seed: int, device: str) -> None:
    """Needles thinner than 1/256 px may turn over in rounding, yet all counts add up."""
    points = needles(50, 40, seed).vertices + 0.0
    inner = ((points > 0) & (points < (50, 40))).all(axis=1)
    points[inner] += np.random.default_rng(seed).normal(0, 1e-3, (int(inner.sum()), 2))
    mesh = delaunay_mesh(points, 50, 40)
    _, times = owners_by_oracle(mesh)
    assert (times == 1).all()
    owners = owners_by_kernel(mesh, Device(device))
    assert owners.min() >= 0


def test_pixel_on_an_edge_belongs_to_the_triangle_right_of_it(device: str) -> None:
    """A pixel's centre on the shared edge goes to the right, on a shared height downwards."""
    points = np.array([[0, 0], [2, 0], [2, 2], [0, 2], [0.5, 0.5]])
    mesh = delaunay_mesh(points, 2, 2)
    centre = mesh.vertices[mesh.triangles].mean(axis=1)
    owner = owners_by_kernel(mesh, Device(device))[0, 0]
    assert centre[owner] == pytest.approx(((0.5 + 2 + 2) / 3, (0.5 + 0 + 2) / 3))
