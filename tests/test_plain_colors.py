"""Triangles that lie on plain ground and reach over a border a little have the ground's colour."""

import numpy as np
import pytest

from stages.mesh import Mesh, mesh_of
from stages.optimize import place_mesh
from stages.solve.fitting import Fitting
from stages.solve.plain_colors import plainer
from tests.kernel_samples import frame_of, random_mesh, waves
from tests.oracles.coverage import covered_pixels, rounded
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device
from warp_kernels.energy.plain_colors import REACH, PlainColors
from warp_kernels.energy.workspace import Workspace

SIZE = 96
MOST_NOISE = 8
"""About the farthest that a pixel of `grained(2.0)` lies from its mean [code values]."""
PAPER, INK = (250, 251, 252), (20, 30, 40)


def letter(ground: np.ndarray) -> np.ndarray:
    """A dark bar on a ground, [SIZE, SIZE, 3] uint8."""
    picture = ground.copy()
    picture[40:58, 30:70] = INK
    return picture.astype(np.uint8)


def paper() -> np.ndarray:
    """Plain ground, [SIZE, SIZE, 3]."""
    return np.broadcast_to(PAPER, (SIZE, SIZE, 3)).astype(np.int64)


def grained(deviation: float) -> np.ndarray:
    """The same under noise."""
    noise = np.random.default_rng(2).normal(0, deviation, (SIZE, SIZE, 1))
    return np.rint(np.clip(paper() - 60 + noise, 0, 255)).astype(np.int64)


def pixels_of(picture: np.ndarray, mesh: Mesh, triangle: int) -> np.ndarray:
    """What a triangle covers, by exact arithmetic [code values], [N, 3]."""
    corners = [rounded(x, y) for x, y in mesh.vertices[mesh.triangles[triangle]].tolist()]
    _, places = covered_pixels(corners, SIZE, SIZE)
    return np.array([picture[row, column] for column, row in places], float).reshape(-1, 3)


def workspace_of(picture: np.ndarray, mesh: Mesh) -> Workspace:
    """A picture and a mesh in it."""
    workspace = Workspace(Device("cpu", 2), (SIZE, SIZE), COLOR_MODELS["constant"])
    workspace.load_image(picture)
    place_mesh(workspace, mesh)
    return workspace


def led(picture: np.ndarray, mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """The means of triangles, and what they become, [T, 3] each."""
    workspace = workspace_of(picture, mesh)
    means, energies, counts = workspace.fit()
    plain, _ = plainer(PlainColors(workspace), counts, means, energies, means)
    return means[:, :, 0], plain[:, :, 0]


def test_few_pixels_of_another_colour_do_not_stain_a_triangle() -> None:
    """Where less than a tenth is ink a triangle is paper, and where less than a tenth is paper ink;
    the energies that are told are those of what is shown."""
    picture, mesh = letter(paper()), random_mesh(SIZE, SIZE, 60)
    snapshot = Fitting(workspace_of(picture, mesh)).snapshot(frame_of(picture), mesh)
    checked = 0
    for triangle in range(mesh.triangle_count):
        pixels = pixels_of(picture, mesh, triangle)
        if len(pixels):
            is_ink = (pixels[:, 0] == INK[0]).mean()
            shown = snapshot.coefficients[triangle, :, 0]
            left = 0.5 * np.square(pixels - shown).sum()
            assert snapshot.energies[triangle] == pytest.approx(left, rel=0.01, abs=0.1)
            for share, color in ((is_ink, PAPER), (1 - is_ink, INK)):
                if 0 < share < 0.1:
                    np.testing.assert_allclose(shown, color, atol=0.01)
                    checked += 1
    assert checked > 3


def test_what_is_not_plain_keeps_its_means() -> None:
    """Noise, and soft waves but for those beside a disc of one colour: every pixel counts."""
    mesh = random_mesh(SIZE, SIZE, 60)
    for picture in (grained(9.0).astype(np.uint8), waves(SIZE, SIZE)):
        means, plain = led(picture, mesh)
        changed = np.abs(plain - means).max(axis=1) > 0.5
        assert changed.mean() < 0.1


def test_half_and_half_keeps_its_mean() -> None:
    """Neither of two colours in equal parts is the ground of the other."""
    picture = paper()
    picture[:, np.arange(SIZE) // 8 % 2 == 1] = 200
    corners = np.array([[0, 0], [SIZE, 0], [SIZE, SIZE], [0, SIZE]], dtype=float)
    mesh = mesh_of(corners, np.array([[0, 1, 2], [0, 2, 3]]), SIZE, SIZE)
    means, plain = led(picture.astype(np.uint8), mesh)
    np.testing.assert_array_equal(plain, means)


def test_pixels_are_counted_as_one_by_one() -> None:
    """The kernel's counts, means and spreads are those of the pixels close to the last colour."""
    picture, mesh = letter(grained(2.0)), random_mesh(SIZE, SIZE, 60)
    workspace = workspace_of(picture, mesh)
    means, energies, counts = workspace.fit()
    found = PlainColors(workspace).measure(counts, means[:, :, 0], energies)
    assert (found.counts > 0).sum() > 20
    for triangle in np.flatnonzero(found.counts):
        pixels = pixels_of(picture, mesh, triangle)
        away = np.abs(pixels - found.colors[triangle]).max(axis=1)
        sure, possible = away < REACH - MOST_NOISE, away < REACH + MOST_NOISE
        assert sure.sum() <= found.counts[triangle] <= possible.sum()
        if sure.sum() == possible.sum():
            close = pixels[sure]
            np.testing.assert_allclose(found.colors[triangle], close.mean(axis=0), atol=1e-9)
            spread = np.sqrt(close.var(axis=0).mean())
            np.testing.assert_allclose(found.spreads[triangle], spread, atol=1e-6)
