"""No pops: what is new fades in over what was there; what persists is untouched, to the bit."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from pipeline.cli import main
from stages.edits import flip_edges, flippable, split_triangles
from stages.look.fading import Fading
from stages.mesh import Mesh, areas_of
from stages.motion.correspondence import by_vertex_id, kept_triangles
from stages.motion.overlaps import overlaps
from stages.render import Renderer
from stages.snapshot import Snapshot
from tests.meshes import HEIGHT, WIDTH, random_mesh, two_triangles
from tests.snapshots import edited, restless_shot, snapshot_with
from tests.tracks import write_clip
from warp_kernels.color_model import LINEAR, QUADRATIC, ColorModel
from warp_kernels.device.device import Device
from warp_kernels.styles import STYLES, Style
from warp_kernels.styles.flat import Flat
from warp_kernels.styles.gradient import Gradient

SIZE = (2 * WIDTH, 2 * HEIGHT)


def play(
    shot: list[Snapshot], frames: int, device: str, style: Style | None = None, threads: int = 2
) -> list[np.ndarray]:
    """Draw a shot as a clip is drawn."""
    picture = (shot[0].mesh.width, shot[0].mesh.height)
    renderer = Renderer(Device(device, threads), picture, SIZE, (style or Flat(),))
    fading = Fading.begin(shot[0], frames)
    pictures = [renderer.render(shot[0], fading)]
    for snapshot in shot[1:]:
        fading = fading.followed_by(snapshot)
        pictures.append(renderer.render(snapshot, fading))
    return pictures


def plainly(snapshot: Snapshot, device: str, style: Style | None = None) -> np.ndarray:
    """Draw a snapshot without what was before it."""
    picture = (snapshot.mesh.width, snapshot.mesh.height)
    return Renderer(Device(device), picture, SIZE, (style or Flat(),)).render(snapshot)


def flipped(mesh: Mesh) -> Mesh:
    """A mesh after a flip of its first edge that can be."""
    edges = mesh.edge_half_edges
    return flip_edges(mesh, edges[flippable(mesh, edges)][:1])


@pytest.mark.parametrize("seed", range(4))
def test_kept_triangles_are_those_of_the_same_vertices(seed: int) -> None:
    """However rows were turned and renumbered."""
    rng = np.random.default_rng(seed)
    before = random_mesh(seed)
    after = edited(before, rng)
    turned = np.array([np.roll(row, rng.integers(3)) for row in after.triangles])
    after = replace(after, triangles=turned)
    known = {tuple(ids): n for n, ids in enumerate(_ids(before))}
    expected = [known.get(tuple(ids), -1) for ids in _ids(after)]
    kept = kept_triangles(before, after)
    assert kept.tolist() == expected
    assert 0 < (kept < 0).sum() < len(kept)


def _ids(mesh: Mesh) -> list[list[int]]:
    return mesh.vertex_ids[by_vertex_id(mesh)].tolist()


def test_overlaps_hold_every_common_point() -> None:
    """Of two meshes over one domain; a mesh overlaps itself one to one, touching does not count."""
    one, other = (mesh.vertices[mesh.triangles] for mesh in (random_mesh(1), random_mesh(2)))
    spans, links = overlaps(one, other)
    found = {(a, b) for a, (begin, end) in enumerate(spans) for b in links[begin:end]}
    points = np.random.default_rng(0).random((2000, 2)) * (WIDTH, HEIGHT)
    assert {*zip(_under(points, one), _under(points, other), strict=True)} <= found
    spans, links = overlaps(one, one[::-1])
    np.testing.assert_array_equal(links, np.arange(len(one))[::-1])
    flat = np.repeat(one[:, :1], 3, axis=1)
    assert len(overlaps(flat, one)[1]) == 0


def _under(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """The triangle under each point [N]."""
    inside = np.ones((len(points), len(corners)), dtype=bool)
    for first in range(3):
        for_all = np.broadcast_to(points[:, None, None], (len(points), len(corners), 1, 2))
        side = np.broadcast_to(corners[None, :, [first, (first + 1) % 3]], (*inside.shape, 2, 2))
        area = areas_of(np.concatenate([side, for_all], axis=2).reshape(-1, 3, 2))
        inside &= area.reshape(inside.shape) >= 0
    return inside.argmax(axis=1)


def test_flip_fades_from_old_to_new(device: str) -> None:
    """Evenly in one direction, never past either end, and done after as many frames as it says."""
    mesh = two_triangles()
    old = snapshot_with(mesh, [(0, 0, 0), (200, 40, 0)])
    new = snapshot_with(flipped(mesh), [(90, 0, 250), (240, 100, 250)])
    ends = [plainly(snapshot, device).astype(int) for snapshot in (old, new)]
    pictures = [picture.astype(int) for picture in play([old, *[new] * 6], 4, device)]
    np.testing.assert_array_equal(pictures[0], ends[0])
    for picture in pictures[5:]:
        np.testing.assert_array_equal(picture, ends[1])
    way = np.sign(ends[1] - ends[0])
    for before, after in pairwise(pictures):
        assert (way * (after - before) >= 0).all()
    for number, share in enumerate((0.104, 0.352, 0.648, 0.896), start=1):  # 3 s^2 - 2 s^3
        wanted = ends[0] + share * (ends[1] - ends[0])
        assert np.abs(pictures[number] - wanted).max() <= 1.0


def test_split_in_the_same_colour_is_invisible(device: str) -> None:
    """Also while the mesh moves and while a second change follows the first."""
    mesh = random_mesh(3)
    colors = np.random.default_rng(1).integers(0, 256, (mesh.triangle_count, 3))
    chosen = np.arange(0, mesh.triangle_count, 3)
    split = split_triangles(mesh, chosen)
    again = np.concatenate([colors, *[colors[chosen]] * 2])
    shot = [snapshot_with(mesh, colors), *[snapshot_with(split, again)] * 3]
    for picture in play(shot, 5, device):
        np.testing.assert_array_equal(picture, plainly(shot[0], device))


@pytest.mark.parametrize("name", ["flat", "edges", "circles", "texture"])
def test_what_persists_is_untouched(name: str, device: str) -> None:
    """Every pixel that lies in triangles from before the fading is the same to the bit."""
    shot = restless_shot(random_mesh(7), 6)
    style = STYLES[name]()
    pictures = play(shot, 3, device, style)
    changed = 0
    for number, snapshot in enumerate(shot[1:], start=1):
        stays = np.ones(snapshot.mesh.triangle_count, dtype=bool)
        for earlier in shot[max(0, number - 3) : number]:
            stays &= kept_triangles(earlier.mesh, snapshot.mesh) >= 0
        mask = plainly(snapshot_with(snapshot.mesh, np.repeat(255 * stays, 3)), device)
        steady = (mask == 255).all(axis=2)
        wanted = plainly(snapshot, device, style)
        np.testing.assert_array_equal(pictures[number][steady], wanted[steady])
        assert 0.02 < steady.mean() < 0.98
        changed += (pictures[number] != wanted).any(axis=2).sum()
    assert changed > 300


def test_zero_frames_are_off(device: str) -> None:
    """The same bits as without; so is the first frame of anything, a still among it."""
    shot = restless_shot(random_mesh(2), 3)
    for snapshot, picture in zip(shot, play(shot, 0, device), strict=True):
        np.testing.assert_array_equal(picture, plainly(snapshot, device))
    np.testing.assert_array_equal(play(shot[:1], 9, device)[0], plainly(shot[0], device))


def test_as_many_frames_as_fade_are_remembered(device: str) -> None:
    """Begun so many frames before, the picture is the same; with any number of threads."""
    shot = restless_shot(random_mesh(9), 9)
    for frames in (1, 3):
        whole = play(shot, frames, device, threads=1)
        for number in (5, 8):
            part = play(shot[number - frames : number + 1], frames, device, threads=3)
            np.testing.assert_array_equal(part[-1], whole[number])


@pytest.mark.parametrize("model", [LINEAR, QUADRATIC], ids=lambda model: model.name)
def test_gradients_show_through_where_they_were(model: ColorModel, device: str) -> None:
    """A picture that the model can hold stays that picture under every change of triangles."""
    mesh = random_mesh(4, inner=6)
    terms = {(0, 0): (20, 220, 60), (1, 0): (1, -1, 0.5), (0, 1): (0.5, 0.5, 0.5)}
    terms |= {(2, 0): (0.01, -0.01, 0), (1, 1): (0, 0, 0.015), (0, 2): (0, 0, -0.01)}
    one = np.array([terms[exponent] for exponent in model.exponents]).T
    split = split_triangles(flipped(mesh), np.arange(0, mesh.triangle_count, 2))
    shot = [
        snapshot_with(each, np.tile(one, (each.triangle_count, 1, 1)), model=model)
        for each in (mesh, flipped(mesh), split, split)
    ]
    first, *later = play(shot, 4, device, Gradient())
    assert 0 < first.min() < first.max() < 255
    for picture in later:
        assert np.abs(picture.astype(int) - first).max() <= 1


def test_curved_colours_fade_from_old_to_new(device: str) -> None:
    """What vanished keeps its own curvature under what came, whose curvature is another."""
    mesh = two_triangles()
    grey = np.zeros((2, 3, QUADRATIC.term_count))
    grey[:, :, QUADRATIC.term(0, 0)] = 128.0
    old, new = grey.copy(), grey.copy()
    old[:, :, QUADRATIC.term(2, 0)] = 90 / mesh.width**2
    new[:, :, QUADRATIC.term(0, 2)] = -90 / mesh.height**2
    shot = [snapshot_with(mesh, old, model=QUADRATIC)]
    shot += [snapshot_with(flipped(mesh), new, model=QUADRATIC)] * 6
    pictures = [picture.astype(int) for picture in play(shot, 4, device, Gradient())]
    assert np.ptp(pictures[0]) > 9
    assert np.ptp(pictures[5]) > 9
    for number, share in enumerate((0.104, 0.352, 0.648, 0.896), start=1):  # 3 s^2 - 2 s^3
        wanted = pictures[0] + share * (pictures[5] - pictures[0])
        assert np.abs(pictures[number] - wanted).max() <= 1.5


def test_part_of_a_track_is_that_of_the_whole(tmp_path: Path) -> None:
    """Animated and rendered, from the middle of a shot, with colours that are fitted again."""
    clip, track = write_clip(tmp_path / "in.mp4"), tmp_path / "in.mtrk"

    def frames(command: str, source: Path, name: str, *flags: str) -> dict[str, bytes]:
        """What a command writes."""
        folder = tmp_path / name
        folder.mkdir()
        out = ["-o", str(folder / "f_##.png"), "--progress", "none"]
        assert main([command, str(source), *out, *flags]) == 0
        return {path.name: path.read_bytes() for path in folder.iterdir()}

    look = ("--blend", "3", "--smooth", "0.6")
    quick = ("--iterations", "2", "--frame-iterations", "4", "--triangles", "90")
    whole = frames("animate", clip, "whole", "--track", str(track), *quick, *look)
    part = frames("render", track, "part", "--frames", "4-7", *look)
    assert part == {name: whole[name] for name in part}
    assert len(part) == 4
    plain = frames("render", track, "plain", "--blend", "0")
    for option in look[:2], look[2:]:
        other = frames("render", track, option[0], "--blend", "0", *option)
        same = [name for name in plain if other[name] == plain[name]]
        assert {"f_00.png", "f_06.png"} <= {*same}  # with these a shot begins
        assert len(same) < 6
    gradient = ("--style", "gradient", *look)
    whole = frames("render", track, "gradient", *gradient)
    part = frames("render", track, "fitted", "--frames", "9-10", *gradient)
    assert part == {name: whole[name] for name in part}
