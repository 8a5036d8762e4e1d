"""Layouts as looks: shown as they are laid, held near that, carried through a clip."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import trimotion
from stages.frame import Frame
from stages.layouts import LAYOUTS
from stages.layouts.hexagons import Hexagons
from stages.layouts.point_file import read_points
from stages.layouts.points import Points
from stages.solve.grid import PLACES
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from tests.tracks import write_clip
from warp_kernels.device.device import Device
from warp_kernels.errors import OptionError, TrimotionError

BLANK = np.zeros((60, 80, 3), dtype=np.uint8)


def picture() -> np.ndarray:
    """A bright disc before a slope, [H, W, 3] uint8."""
    y, x = np.mgrid[:96, :128]
    disc = (x - 70) ** 2 + (y - 40) ** 2 < 30**2
    return np.repeat(np.where(disc, 230, x)[..., None], 3, axis=2).astype(np.uint8)


def test_hexagons_are_equal() -> None:
    mesh = Hexagons().build(np.zeros((600, 800, 3), np.uint8), 900, np.random.default_rng(0))
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    fans = np.diff(mesh.fan_offsets)[inner]
    assert (fans == 6).mean() > 0.9  # and five beside the border
    sides = np.linalg.norm(np.diff(mesh.vertices[mesh.edge_vertices], axis=1)[:, 0], axis=1)
    assert np.quantile(sides, 0.9) < 1.2 * np.quantile(sides, 0.1)


def test_rings_lie_around_their_centre() -> None:
    layout = LAYOUTS["radial"](center_x=0.25, focus=1.0)
    mesh = layout.build(np.zeros((300, 400, 3), np.uint8), 700, np.random.default_rng(0))
    away = np.linalg.norm(mesh.corners.mean(axis=1) - (100, 150), axis=1)
    assert mesh.areas[away < 50].mean() < 0.4 * mesh.areas[away > 150].mean()
    with pytest.raises(OptionError, match="focus=2: must lie between 0 and 1"):
        LAYOUTS["radial"](focus=2.0)


def test_points_lie_on_edges() -> None:
    mesh = LAYOUTS["edges"]().build(picture(), 150, np.random.default_rng(0))
    inner = mesh.vertices[~(mesh.on_left_right | mesh.on_top_bottom)]
    off = np.abs(np.linalg.norm(inner - (70.5, 40.5), axis=1) - 30)
    assert (off < 1.5).mean() > 0.25  # where an even layout has a tenth


FORMS = {
    "a.csv": 'name,x,y\n"a",10,20\nb,70,50\n',
    "b.txt": "# mine\n10 20\n\n70;50\n",
    "c.json": '{"points": [[10, 20], {"x": 70, "y": 50}]}',
    "d.txt": "0.125\t0.33333333333333\n0.875,0.83333333333333\n",
}


@pytest.mark.parametrize("name", FORMS)
def test_points_of_a_file(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text(FORMS[name])
    mesh = Points(read_points(str(tmp_path / name))).build(BLANK, 9, np.random.default_rng(0))
    inner = mesh.vertices[~(mesh.on_left_right | mesh.on_top_bottom)]
    assert np.sort(inner, axis=0) == pytest.approx(np.array([[10, 20], [70, 50]]), abs=1e-6)
    assert mesh.triangle_count == 6


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "holds 0 points"),
        ("1 2\n3\n", "line 2: '3' is no point"),
        ("a b\n", "line 1: 'a b' is no point"),
        ("1 nan\n", "not finite"),
        ('{"dots": []}', "without a list of points"),
        ("[[1, 2], [3]]", r"point 2 is \[3\]"),
        ("[[1, 2", "Expecting"),
    ],
)
def test_points_that_are_none(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "a.txt").write_text(text)
    with pytest.raises(TrimotionError, match=message) as told:
        read_points(str(tmp_path / "a.txt"))
    assert "\n" not in str(told.value)


def test_points_beside_the_picture() -> None:
    with pytest.raises(OptionError, match="1 of 2 points lie beside the picture of 80x60"):
        Points(np.array([[5.0, 5.0], [90, 5]])).build(BLANK, 9, np.random.default_rng(0))
    with pytest.raises(OptionError, match="needs a file"):
        Points().build(BLANK, 9, np.random.default_rng(0))


def test_a_layout_is_held(device: str) -> None:
    """The more it is kept, the less vertices move; with 1, and without iterations, not at all."""
    pixels = picture()
    layout = Hexagons().build(pixels, 100, np.random.default_rng(0))
    moved = []
    for keep, iterations in ((0.5, 60), (0.9, 60), (1.0, 60), (0.0, 0)):
        options = TriangulateOptions(
            keep_layout=keep, iterations=iterations, refine=RefineOptions(triangles=100)
        )
        frame = Frame(0, 0, Fraction(1, 25), pixels)
        with Device(device) as opened:
            triangulator = Triangulator(opened, (128, 96), options)
            mesh = triangulator.first(frame, Hexagons(), np.random.default_rng(0)).mesh
        known = np.isin(mesh.vertex_ids, layout.vertex_ids)
        old = layout.vertices[np.searchsorted(layout.vertex_ids, mesh.vertex_ids[known])]
        moved.append(np.linalg.norm(mesh.vertices[known] - old, axis=1).mean())
        if keep == 1.0 or iterations == 0:
            assert np.array_equal(mesh.triangles, layout.triangles)
    assert moved[0] > 2 * moved[1] > 0
    assert moved[2] == moved[3] < 1 / PLACES  # no further than a solution is rounded
    with pytest.raises(OptionError, match="--keep-layout 2: must lie between"):
        TriangulateOptions(keep_layout=2.0)


@pytest.mark.parametrize("keep", [0.6, 1.0])
def test_a_held_layout_is_followed_and_gone_on_with(tmp_path: Path, keep: float) -> None:
    clip = write_clip(tmp_path / "clip.mp4")
    options = {"iterations": 8, "frame_iterations": 6, "triangles": 40, "focus": "none"}
    options |= {"layout": "phyllotaxis", "keep_layout": keep}
    trimotion.solve(clip, tmp_path / "one.mtrk", **options)
    trimotion.solve(clip, tmp_path / "two.mtrk", frames="0-3", **options)
    trimotion.solve(clip, tmp_path / "two.mtrk", resume=True, **options)
    with (
        trimotion.open_track(tmp_path / "one.mtrk") as whole,
        trimotion.open_track(tmp_path / "two.mtrk") as resumed,
    ):
        for frame, again in zip(whole, resumed, strict=True):
            assert np.array_equal(frame.vertices, again.vertices)
            assert np.array_equal(frame.triangles, again.triangles)
