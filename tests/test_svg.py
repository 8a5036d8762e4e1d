"""SVG says in shapes what styles draw in pixels."""

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from meshes import random_mesh
from PIL import Image

import trimotion
from stages.exchange.exchange_options import ExchangeOptions
from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.plane.hatch import hatched
from stages.exchange.svg.document import Svg
from stages.exchange.svg.slopes import Slopes, best_slopes, channel_slopes
from stages.look.framing import Framing
from stages.look.paint import paint_of
from stages.snapshot import Snapshot
from trimotion import OptionError
from warp_kernels.color_model import CONSTANT
from warp_kernels.drawing.paint import Paint
from warp_kernels.scene.stroke_lay import own_lay
from warp_kernels.styles.flat import Flat

DOCUMENT = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def track(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three frames of 96 x 64 in 24 triangles, linear colours."""
    folder = tmp_path_factory.mktemp("svg")
    rng = np.random.default_rng(5)
    blobs = rng.integers(0, 256, (4, 6, 3), dtype=np.uint8)
    for frame in range(3):
        picture = Image.fromarray(np.roll(blobs, frame, axis=1)).resize((96, 64))
        picture.save(folder / f"in_{frame:02}.png")
    target = folder / "in.mtrk"
    trimotion.solve(folder / "in_##.png", target, triangles=24, iterations=3, color="linear")
    return target


def written(track: Path, name: str, **options: object) -> Path:
    target = track.parent / name
    trimotion.render(track, target, overwrite=True, **options)  # type: ignore[arg-type]
    return target


def linear_paint(seed: int) -> Paint:
    """Steep and even colours, some of them limited."""
    mesh, rng = random_mesh(seed=seed), np.random.default_rng(seed)
    count = mesh.triangle_count
    colors = rng.uniform(60, 200, (count, 3))
    gradients = rng.normal(0, 3, (count, 2, 3)) * rng.integers(0, 2, (count, 1, 3))
    limits = np.stack([colors - rng.uniform(0, 60, (count, 3)), colors + 50], axis=1)
    return Paint(colors, gradients, None, limits, mesh.corners, mesh.triangle_ids)


def shown(slopes: Slopes, points: np.ndarray) -> np.ndarray:
    """What a renderer shows of gradients at a point of each."""
    along = slopes.ends - slopes.begins
    square = np.maximum((along * along).sum(axis=1), 1e-30)
    share = np.clip(((points - slopes.begins) * along).sum(axis=1) / square, 0.0, 1.0)
    first = slopes.first.astype(float)
    return first + share[:, None] * (slopes.last - first)


def linear_colors(paint: Paint, points: np.ndarray) -> np.ndarray:
    away = points - paint.corners.mean(axis=1)
    colors = paint.colors + np.einsum("ti,tic->tc", away, paint.gradients)
    return np.clip(colors, paint.limits[:, 0], paint.limits[:, 1])


@pytest.mark.parametrize("seed", [1, 2])
def test_gradients_of_channels_add_up_to_the_colours(seed: int) -> None:
    paint, rng = linear_paint(seed), np.random.default_rng(seed)
    for _ in range(8):
        weights = rng.dirichlet(np.ones(3), len(paint.ids))
        points = np.einsum("tk,tki->ti", weights, paint.corners)
        whole = sum(shown(channel_slopes(paint, channel), points) for channel in range(3))
        assert np.abs(whole - linear_colors(paint, points)).max() < 1.0


def test_a_single_gradient_is_the_nearest_one() -> None:
    """No other direction leaves less: residuals of regressions on positions along each."""
    paint = linear_paint(3)
    away = paint.corners - paint.corners.mean(axis=1, keepdims=True)
    spread = np.einsum("tki,tkj->tij", away, away) / 12
    turns = np.linspace(0, np.pi, 721)
    directions = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    both = np.einsum("tij,tjc->tic", spread, paint.gradients)
    whole = np.einsum("tic,tic->t", paint.gradients, both)
    told = (np.einsum("ni,tic->tnc", directions, both) ** 2).sum(axis=2)
    told /= np.einsum("ni,tij,nj->tn", directions, spread, directions)
    least = np.maximum(whole - told.max(axis=1), 0.0) / 3
    slopes, errors = best_slopes(paint)
    np.testing.assert_allclose(errors, least, rtol=0.02, atol=1e-3 * whole.max() / 3)
    ends = np.stack([slopes.begins, slopes.ends], axis=1)
    along = np.einsum("tki,ti->tk", away, slopes.ends - slopes.begins)
    reach = np.einsum(
        "tki,ti->tk", ends - paint.corners.mean(axis=1, keepdims=True), slopes.ends - slopes.begins
    )
    np.testing.assert_allclose(reach[:, 1] - reach[:, 0], np.ptp(along, axis=1), rtol=1e-6)


def test_gradients_add_up_and_hide_the_single_ones(track: Path) -> None:
    text = written(track, "g.svg", styles="gradient", frames=0).read_text()
    root = ElementTree.fromstring(text)
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(ids) == len(set(ids))
    named = set(re.findall(r"url\(#([^)]+)\)", text))
    assert named
    assert named <= set(ids)
    assert text.count("mix-blend-mode:screen") == 4  # two channels, the single ones, and the rule
    plain = written(track, "p.svg", styles="gradient", frames=0, svg_gradients="plain").read_text()
    assert "mix-blend-mode" not in plain
    assert 3 * len(plain) < len(text)
    with pytest.raises(OptionError, match="choose from exact, plain"):
        written(track, "q.svg", styles="gradient", frames=0, svg_gradients="both")


@pytest.mark.parametrize("tone", [0.03, 0.3, 0.8])
def test_strokes_lie_in_their_triangles_and_reach_the_tone(tone: float) -> None:
    mesh = random_mesh(seed=8)
    lay, width = own_lay(mesh.triangle_ids, mesh.corners), 0.25
    tones = np.full(mesh.triangle_count, tone)
    found = hatched(mesh.corners, lay, 20.0, 0.25, tones, width)
    sides = found.ends[:, 1] - found.ends[:, 0]
    lengths = np.hypot(*sides.T)
    inked = np.bincount(found.triangles, weights=width * lengths, minlength=len(tones))
    is_wide = mesh.heights > 8 * width
    assert is_wide.sum() > 10
    np.testing.assert_allclose((inked / mesh.areas)[is_wide], tone, rtol=1e-4)
    across = 0.5 * width * np.stack([-sides[:, 1], sides[:, 0]], axis=1) / lengths[:, None]
    corners = mesh.corners[found.triangles]
    edges = np.roll(corners, -1, axis=1) - corners
    for side in (-1, 0, 1):
        for end in range(2):
            away = (found.ends[:, end] + side * across)[:, None] - corners
            depth = edges[..., 0] * away[..., 1] - edges[..., 1] * away[..., 0]
            depth /= np.hypot(edges[..., 0], edges[..., 1])
            assert depth[is_wide[found.triangles]].min() > (-1e-6 if tone < 0.5 else -width)


@pytest.mark.parametrize(
    "style", ["hatching", "crosshatching:paper=#fff,ink=#000", "hatching:colored=1"]
)
def test_strokes_are_as_dark_as_those_that_are_drawn(track: Path, style: str) -> None:
    """Means of the whole picture; lines and papers of an SVG mix code values."""
    drawn = np.asarray(Image.open(written(track, "t.png", styles=style, frames=0)), float)
    root = ElementTree.parse(written(track, "t.svg", styles=style, frames=0)).getroot()
    height, width = drawn.shape[:2]
    picture = np.zeros(3)
    papers = {p.get("id"): p for p in root.iter(f"{DOCUMENT}path") if p.get("fill")}
    one = next(iter(trimotion.open_track(track)))
    corners = one.vertices[one.triangles]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = 0.5 * np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    pens = {g.get("id"): g for g in root.iter(f"{DOCUMENT}g") if g.get("stroke-width")}
    strokes = {}
    for group in pens.values():
        for path in group.iter(f"{DOCUMENT}path"):
            strokes[path.get("id")] = (path.get("stroke") or group.get("stroke"), path.get("d"))
    pen_width = float(next(iter(pens.values())).get("stroke-width") or 0)
    name = style.partition(":")[0]
    for number, area in zip(one.triangle_ids, areas, strict=True):
        cut = papers.get(f"{name}-paper-cut-{number}")
        paper = color_of("#ffffff" if cut is None else cut.get("fill"))
        picture += area * paper
        if f"{name}-{number}" in strokes:
            pen, data = strokes[f"{name}-{number}"]
            ends = np.array(re.findall(r"-?[\d.]+", data), float).reshape(-1, 2, 2)
            length = np.hypot(*(ends[:, 1] - ends[:, 0]).T).sum()
            picture += pen_width * length * (color_of(pen) - paper)
    picture /= height * width
    # strokes that cross cover less than they are long
    slack = 12 if "cross" in style else 4
    assert np.abs(picture - drawn.reshape(-1, 3).mean(axis=0)).max() < slack


def color_of(text: str) -> np.ndarray:
    return np.array([int(text[i : i + 2], 16) for i in (1, 3, 5)], float)


def test_a_pen_a_layer_in_millimetres(track: Path) -> None:
    style = "crosshatching:paper=none,ink=#102030"
    path = written(track, "m.svg", styles=style, frames=0, mm=300)
    root = ElementTree.parse(path).getroot()
    assert (root.get("width"), root.get("height")) == ("300mm", "200mm")
    assert root.get("viewBox") == "0 0 96 64"
    label = "{http://www.inkscape.org/namespaces/inkscape}label"
    pens = [group for group in root.iter(f"{DOCUMENT}g") if group.get("stroke")]
    assert [pen.get(label) for pen in pens] == ["1 #102030"]
    assert not list(root.iter(f"{DOCUMENT}rect"))
    with pytest.raises(OptionError, match="between 1 and 10000"):
        written(track, "n.svg", styles=style, frames=0, mm=-1)


def test_frames_are_shown_in_turn_for_ever(track: Path) -> None:
    text = written(track, "film.svg", styles="gradient").read_text()
    assert "<script" not in text
    root = ElementTree.fromstring(text)
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(ids) == len(set(ids))
    assert set(re.findall(r"url\(#([^)]+)\)", text)) <= set(ids)
    frames = root.findall(f"{DOCUMENT}g")
    assert [frame.get("display") for frame in frames] == [None, "none", "none"]
    moves = [frame[0] for frame in frames]
    assert {move.get("repeatCount") for move in moves} == {"indefinite"}
    assert len({move.get("dur") for move in moves}) == 1
    for share in np.linspace(0, 1, 31)[:-1]:
        shown = []
        for move in moves:
            places = np.array((move.get("keyTimes") or "").split(";"), float)
            assert places[0] == 0
            values = (move.get("values") or "").split(";")
            shown.append(values[np.searchsorted(places, share, side="right") - 1])
        assert shown.count("inline") == 1


def test_a_film_that_would_be_too_large_is_told_at_its_second_frame() -> None:
    mesh, framing = random_mesh(seed=8), Framing((64, 64), (64, 64), None)
    film = Film(
        "in", ".svg", (64, 64), framing, None, (Flat(),), 0, None, 10**5, None, ExchangeOptions()
    )
    one, count = Svg(film), mesh.triangle_count
    colors, zero = np.full((count, 3, 1), 90.0), np.zeros(count)
    snapshot = Snapshot(0, 0, Fraction(1), mesh, CONSTANT, colors, zero, zero.astype(np.int64))
    one.add(Figure(snapshot, 0, Fraction(0), paint_of(snapshot)))
    later = replace(snapshot, frame_index=1)
    with pytest.raises(OptionError, match=r"100000 frames make .* MB.*--triangles") as caught:
        one.add(Figure(later, 0, Fraction(1), paint_of(later)))
    assert "\n" not in str(caught.value)
