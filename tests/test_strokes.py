"""Strokes over time: they move with the picture and outlive what becomes of their triangles."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pipeline.cli import main
from stages.edits import flip_edges, flippable, split_triangles
from stages.look.strokes import SHARERS, THIN, Strokes
from stages.mesh import Mesh, mesh_of
from stages.render import Renderer
from tests.meshes import HEIGHT, WIDTH, random_mesh
from tests.snapshots import edited, snapshot_with
from tests.tracks import write_clip
from warp_kernels.device.device import Device
from warp_kernels.scene.stroke_lay import Lay
from warp_kernels.styles.hatching import Hatching

QUICK = ("--iterations", "2", "--frame-iterations", "4", "--triangles", "60")
SHEET = "hatching:paper=#f8f4ea"


def moved(mesh: Mesh, step: np.ndarray) -> Mesh:
    """A mesh whose inner vertices have moved [px], and none other."""
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    return mesh.moved(mesh.vertices + step * inner[:, None])


def phases(lay: Lay, points: np.ndarray) -> np.ndarray:
    """How far points [N, 2] lie along and aside in the patterns of as many triangles [px]."""
    along, away = lay.directions, points - lay.places
    aside = np.stack([-along[:, 1], along[:, 0]], axis=1)
    return np.stack([(along * away).sum(axis=1), (aside * away).sum(axis=1)], axis=1)


def are_thin(mesh: Mesh) -> np.ndarray:
    """Which triangles are too low for strokes across them, [T] bool."""
    sides = np.linalg.norm(mesh.corners - np.roll(mesh.corners, 1, axis=1), axis=2)
    return 2.0 * mesh.areas < 1.01 * THIN * np.square(sides.max(axis=1))


def centres(mesh: Mesh) -> np.ndarray:
    """Centroids [px], [T, 2]."""
    return mesh.corners.mean(axis=1)


def test_a_picture_that_comes_again_is_drawn_again(device: str) -> None:
    """To the bit, and as a still is, which knows nothing of strokes that go on."""
    mesh = random_mesh(4)
    begun = Strokes.begin(mesh)
    again = begun.followed_by(replace(mesh))
    assert again.lay is begun.lay
    snapshot = snapshot_with(mesh, np.full((mesh.triangle_count, 3), 120.0))
    size = (WIDTH, HEIGHT)
    renderer = Renderer(Device(device), size, size, (Hatching(paper="#fff"),))
    np.testing.assert_array_equal(
        renderer.render(snapshot), renderer.render(snapshot, lay=again.lay)
    )


def test_strokes_are_carried_along() -> None:
    """A moving picture takes them along as one piece, also where triangles end on its border."""
    mesh, step = random_mesh(1), np.array([0.03, -0.02])
    before = Strokes.begin(mesh)
    after = before.followed_by(moved(mesh, step))
    steps = np.tile(step, (mesh.triangle_count, 1))
    np.testing.assert_allclose(after.lay.places - before.lay.places, steps, atol=1e-9)
    np.testing.assert_allclose(after.lay.directions, before.lay.directions, atol=1e-9)


def test_a_vertex_alone_moves_strokes_little() -> None:
    """The optimiser shifts single vertices; those around say that the picture stands still."""
    mesh = random_mesh(1)
    inner = np.flatnonzero(~(mesh.on_left_right | mesh.on_top_bottom))
    step = np.zeros(mesh.vertices.shape)
    step[inner[7], 0] = 0.6
    shifted = mesh.moved(mesh.vertices + step)
    before = Strokes.begin(mesh)
    after, tied = before.followed_by(shifted), Strokes.begin(shifted)
    carried, own = (
        np.linalg.norm(s.lay.places - before.lay.places, axis=1).max() for s in (after, tied)
    )
    assert own > 0.19
    assert carried < 0.6 * own
    turned, own_turn = (
        np.linalg.norm(s.lay.directions - before.lay.directions, axis=1).max()
        for s in (after, tied)
    )
    assert turned < 0.2 * own_turn


def test_strokes_turn_with_the_picture() -> None:
    """Directions turn by up to its angle, and places go where the picture takes them."""
    mesh = random_mesh(2)
    angle, middle = 0.01, np.array([WIDTH, HEIGHT]) / 2
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned = replace(mesh, vertices=(mesh.vertices - middle) @ turn.T + middle)
    before = Strokes.begin(mesh)
    after = before.followed_by(turned)
    (x, y), (u, v) = before.lay.directions.T, after.lay.directions.T
    angles = np.arcsin(x * v - y * u)
    assert angles.min() > -0.2 * angle
    assert angles.max() < 1.01 * angle
    assert np.median(angles) > 0.3 * angle
    expected = (before.lay.places - middle) @ turn.T + middle
    assert np.abs(after.lay.places - expected).max() < 0.15


@pytest.mark.parametrize("kind", ["flip", "split"])
def test_what_becomes_of_a_triangle_does_not_matter_to_its_strokes(kind: str) -> None:
    """Whoever keeps its id keeps every stroke where it was."""
    mesh = random_mesh(3)
    if kind == "flip":
        edges = mesh.edge_half_edges[flippable(mesh, mesh.edge_half_edges, min_height=0.2)]
        after = flip_edges(mesh, edges[:1])
    else:
        after = split_triangles(mesh, np.arange(0, mesh.triangle_count, 3))
    begun = Strokes.begin(mesh)
    found = begun.followed_by(after)
    rows = np.flatnonzero(np.isin(after.triangle_ids, mesh.triangle_ids))
    np.testing.assert_array_equal(after.triangle_ids[rows], mesh.triangle_ids)
    assert not np.array_equal(after.triangles[rows], mesh.triangles)
    np.testing.assert_array_equal(found.lay.owners[rows], mesh.triangle_ids)
    points, fat = centres(mesh), ~are_thin(after)[rows]
    np.testing.assert_allclose(
        phases(found.lay.of(rows), points)[fat], phases(begun.lay, points)[fat], atol=1e-9
    )


def test_strokes_never_run_across_what_becomes_thin() -> None:
    """Then it has new ones along it; as long as it is not, its strokes stay as they are."""
    points = np.array([[0, 0], [40, 0], [40, 30], [0, 30]], dtype=float)
    for first in range(6):
        mesh = mesh_of(points, [[0, 1, 2], [0, 2, 3]], 40, 30)
        mesh = replace(mesh, triangle_ids=first + np.arange(2))
        strokes = Strokes.begin(mesh)
        for width in np.linspace(40, 3, 12):
            narrow = mesh.moved(np.where(points[:, :1] > 0, [width, 0], [0, 0]) + points * [0, 1])
            strokes = strokes.followed_by(narrow)
        assert (np.abs(strokes.lay.directions[:, 1]) > 0.5).all()


def test_a_part_goes_on_with_the_strokes_of_the_whole() -> None:
    """One of the two that a split adds; the other one has its own, for no three show the same."""
    mesh = random_mesh(3)
    chosen = np.arange(0, mesh.triangle_count, 4)
    split = split_triangles(mesh, chosen)
    begun = Strokes.begin(mesh)
    found = begun.followed_by(split)
    new = np.arange(mesh.triangle_count, split.triangle_count)
    heirs = new[found.lay.owners[new] < mesh.next_triangle_id]
    assert 0.9 * len(chosen) < len(heirs) <= len(chosen)  # thin parts have their own, too
    parents = found.lay.owners[heirs]
    assert len(set(parents)) == len(parents)
    assert set(parents) <= set(mesh.triangle_ids[chosen])
    rows = np.searchsorted(mesh.triangle_ids, parents)
    points = centres(split)[heirs]
    np.testing.assert_allclose(
        phases(found.lay.of(heirs), points), phases(begun.lay.of(rows), points), atol=1e-9
    )


def test_no_kind_of_strokes_spreads() -> None:
    """Over many frames that flip, split and collapse: each triangle its own, or one shares it."""
    mesh, rng = random_mesh(5), np.random.default_rng(1)
    strokes = Strokes.begin(mesh)
    for _ in range(30):
        mesh = edited(mesh, rng)
        strokes = strokes.followed_by(mesh)
        lengths = np.linalg.norm(strokes.lay.directions, axis=1)
        np.testing.assert_allclose(lengths, 1.0, atol=1e-6)
    shared = np.unique(strokes.lay.owners, return_counts=True)[1]
    assert shared.max() <= SHARERS
    assert (strokes.lay.owners == mesh.triangle_ids).mean() > 0.5


def frames(command: str, source: Path, folder: Path, *flags: str) -> dict[int, bytes]:
    """What a command writes, by frame."""
    folder.mkdir()
    out = ["-o", str(folder / "f_##.png"), "--progress", "none"]
    assert main([command, str(source), *out, *flags]) == 0
    return {int(path.stem[-2:]): path.read_bytes() for path in sorted(folder.iterdir())}


def test_part_is_that_of_the_whole(tmp_path: Path) -> None:
    """A range is drawn as in the whole, and a track as what is drawn while it is solved."""
    clip, track = write_clip(tmp_path / "in.mp4"), tmp_path / "in.mtrk"
    look = ("--style", SHEET, "--smooth", "0.5")
    drawn = frames("animate", clip, tmp_path / "a", *QUICK, *look, "--track", str(track))
    whole = frames("render", track, tmp_path / "whole", *look)
    assert whole == drawn
    for number, wanted in enumerate(("4-5", "0-0", "7-8", "10-11")):
        part = frames("render", track, tmp_path / str(number), "--frames", wanted, *look)
        assert part == {frame: whole[frame] for frame in part}
    jobs = frames("animate", clip, tmp_path / "j", *QUICK, *look, "--jobs", "2")
    assert jobs == whole
