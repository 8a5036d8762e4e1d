"""Outputs that are shapes and numbers: they hold what was solved, or say what they cannot hold."""

import csv
import re
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
from meshes import random_mesh
from PIL import Image

import trimotion
from stages.exchange import FORMATS, format_of
from stages.exchange.svg.merged import merged_outlines
from stages.exchange.svg.outlines import STRIP, triangle_outlines
from stages.media.naming import SHAPES
from trimotion import OptionError, OutputError
from warp_kernels.styles import STYLES

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def track(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two frames of 64 x 48 in 40 triangles, linear colours."""
    folder = tmp_path_factory.mktemp("exchange")
    rng = np.random.default_rng(3)
    blobs = rng.integers(0, 256, (6, 8, 3), dtype=np.uint8)
    for frame in range(2):
        picture = Image.fromarray(np.roll(blobs, frame, axis=1)).resize((64, 48))
        picture.save(folder / f"in_{frame:02}.png")
    target = folder / "in.mtrk"
    trimotion.solve(folder / "in_##.png", target, triangles=40, iterations=4, color="linear")
    return target


def written(track: Path, name: str, **options: object) -> Path:
    target = track.parent / name
    trimotion.render(track, target, overwrite=True, **options)  # type: ignore[arg-type]
    return target


def test_registry_and_endings_agree() -> None:
    assert FORMATS.keys() == SHAPES.keys()
    for ending in FORMATS:
        assert set(format_of(f"a{ending}").styles) <= set(STYLES)


@pytest.mark.parametrize("ending", sorted(FORMATS))
def test_numbered_files_and_single_frames(track: Path, ending: str) -> None:
    if ending.startswith(".usd"):
        pytest.importorskip("pxr", reason="pip install usd-core")
    written(track, f"n_##{ending}", styles="flat")
    for number in range(2):
        assert (track.parent / f"n_{number:02}{ending}").stat().st_size > 100
    one = written(track, f"one{ending}", styles="flat", frames=1)
    assert one.read_bytes() == (track.parent / f"n_01{ending}").read_bytes()


def test_arrays_hold_every_frame(track: Path) -> None:
    with np.load(written(track, "all.npz", styles="flat")) as found:
        arrays = dict(found)
    for number, one in enumerate(trimotion.open_track(track)):
        a, b = arrays["vertex_offsets"][number : number + 2]
        c, d = arrays["triangle_offsets"][number : number + 2]
        np.testing.assert_array_equal(arrays["vertices"][a:b], one.vertices)
        np.testing.assert_array_equal(arrays["triangles"][c:d], one.triangles)
        np.testing.assert_array_equal(arrays["triangle_ids"][c:d], one.triangle_ids)
        np.testing.assert_array_equal(arrays["colors"][c:d], one.colors)


def test_table_reads_back_equal(track: Path) -> None:
    with written(track, "all.csv", styles="flat").open(newline="") as file:
        rows = list(csv.DictReader(file))
    frames = list(trimotion.open_track(track))
    assert len(rows) == sum(len(one.triangles) for one in frames)
    found = [
        [float(row[f"{axis}{corner}"]) for corner in range(3) for axis in "xy"] for row in rows
    ]
    corners = [one.vertices[one.triangles].reshape(-1, 6) for one in frames]
    np.testing.assert_array_equal(found, np.concatenate(corners))


def test_solids_read_back_equal(track: Path) -> None:
    one = next(iter(trimotion.open_track(track)))
    corners = one.vertices[one.triangles][:, [0, 2, 1]]
    wanted = np.dstack([corners[..., 0], 48 - corners[..., 1], 0 * corners[..., 0]])
    text = written(track, "a.obj", styles="flat", frames=0).read_text()
    rows = np.array([line.split()[1:] for line in text.splitlines() if line[0] == "v"], float)
    np.testing.assert_array_equal(
        rows[:, :3].astype(np.float32), wanted.reshape(-1, 3).astype("f4")
    )
    np.testing.assert_array_equal(np.rint(255 * rows[::3, 3:]), one.colors)
    data = written(track, "a.ply", styles="flat", frames=0).read_bytes()
    body = data[data.index(b"end_header\n") + 11 :]
    kind = [("place", "<f4", 3), ("color", "u1", 3)]
    vertices = np.frombuffer(body, kind, len(rows))
    np.testing.assert_array_equal(vertices["place"], wanted.reshape(-1, 3).astype("f4"))
    np.testing.assert_array_equal(vertices["color"][::3], one.colors)


def test_strips_stay_in_neighbours_that_are_drawn_later() -> None:
    """A strip is inside of one later triangle, and no deeper than it may be."""
    mesh = random_mesh(seed=8)
    outlines = triangle_outlines(mesh)
    ends = np.cumsum(outlines.counts)
    corners, strips = mesh.corners, 0
    for triangle, (begin, end) in enumerate(zip(ends - outlines.counts, ends, strict=True)):
        points = outlines.points[begin:end]
        own = {tuple(corner) for corner in corners[triangle]}
        for point in points:
            if tuple(point) in own:
                continue
            strips += 1
            homes = [t for t in range(triangle + 1, len(corners)) if holds(corners[t], point)]
            assert homes
            assert not holds(corners[triangle], point, -1e-9)
    assert strips > len(corners)
    assert STRIP > 2**0.5


def holds(corners: np.ndarray, point: np.ndarray, slack: float = 1e-6) -> bool:
    sides = np.roll(corners, -1, axis=0) - corners
    away = point - corners
    lengths = np.hypot(*sides.T)
    return bool(((sides[:, 0] * away[:, 1] - sides[:, 1] * away[:, 0]) / lengths > -slack).all())


def test_merged_shapes_keep_every_triangle() -> None:
    mesh = random_mesh(seed=8)
    colors = np.zeros((mesh.triangle_count, 3), np.uint8)
    whole = merged_outlines(mesh, colors)
    assert len(whole.spans) == 1
    points = whole.outlines.points
    x, y = points.T
    area = 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()
    assert area == pytest.approx(mesh.width * mesh.height)
    colors[:, 0] = np.arange(mesh.triangle_count)
    apart = merged_outlines(mesh, colors)
    np.testing.assert_array_equal(apart.outlines.points, triangle_outlines(mesh).points)


def test_svg_has_layers_ids_and_the_picture_s_units(track: Path) -> None:
    styles = ["paper:grain=0", "flat:opacity=0.5,blend=multiply", "edges:fade=9", "shrink"]
    styles += ["circles", "incircles:size=1.2"]
    path = written(track, "all.svg", styles=styles, frames=0, scale=2)
    root = ElementTree.parse(path).getroot()
    assert (root.get("width"), root.get("viewBox")) == ("128", "0 0 64 48")
    layers = root.findall(f"{SVG}g")
    assert [layer.get("id") for layer in layers] == [s.split(":")[0] for s in styles]
    assert (layers[1].get("opacity"), layers[1].get("style")) == ("0.5", "mix-blend-mode:multiply")
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(ids) == len(set(ids))
    one = next(iter(trimotion.open_track(track)))
    fills = [path.get("fill") for path in layers[3].iter(f"{SVG}path")]
    assert fills == ["#{:02x}{:02x}{:02x}".format(*color) for color in one.colors]
    assert {f"flat-{number}" for number in one.triangle_ids} <= set(ids)


def test_svg_precision_and_bars(track: Path) -> None:
    path = written(track, "b.svg", styles="flat", frames=0, svg_precision=0, size=(128, 128))
    text = path.read_text()
    assert 'viewBox="0 -8 64 64"' in text
    assert not re.search(r' d="[^"]*\.', text)


def test_a_palette_is_merged_and_toned(track: Path) -> None:
    options = {"styles": "flat", "frames": 0, "palette": "#000,#fff:mode=nearest"}
    path = written(track, "c.svg", svg_merge=True, **options)
    fills = re.findall(r'<path [^>]*fill="(#\w+)"', path.read_text())
    assert set(fills) <= {"#000000", "#ffffff"}
    assert 1 < len(fills) < 40


@pytest.mark.parametrize("ending", sorted(FORMATS))
def test_a_frame_of_a_program_is_written_as_that_of_a_track(track: Path, ending: str) -> None:
    style = "flat" if "flat" in format_of(f"a{ending}").styles else "edges"
    one = trimotion.open_track(track)[0]
    target = track.parent / f"saved{ending}"
    assert one.save(target, style) == []
    with pytest.raises(OutputError, match="overwrite=True"):
        one.save(target, style)
    drawn = written(track, f"drawn{ending}", styles=style, frames=0)
    if ending in (".svg", ".dxf", ".ply", ".obj", ".csv"):
        lines = [path.read_text("latin-1").splitlines() for path in (target, drawn)]
        differing = [pair for pair in zip(*lines, strict=True) if pair[0] != pair[1]]
        # the name of the source is all that is not there
        assert all(line[:2] in ("<t", "o ") for p in differing for line in p)


def test_a_picture_of_a_program_is_written() -> None:
    y, x = np.mgrid[:40, :60]
    pixels = np.stack([4 * x, 6 * y, 0 * x + 60], axis=2).astype(np.uint8)
    one = trimotion.triangulate(pixels, triangles=12)
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "a.svg"
        told = one.save(target, ["gradient", "edges"], scale=2, svg_gradients="plain")
        assert len(told) == 1
        assert "single gradients are off" in told[0]
        root = ElementTree.parse(target).getroot()
        assert (root.get("width"), root.get("viewBox")) == ("120", "0 0 60 40")
        with pytest.raises(OptionError, match="draw makes pixels"):
            one.save(Path(folder) / "a.png")


REFUSED = [
    ("a.svg", {"styles": "lenses"}, "lenses: .svg cannot hold it"),
    ("a.svg", {"styles": "paper"}, "paper:grain=0.4: .svg cannot hold a grain"),
    ("a.svg", {"styles": "flat", "blend": 2}, "blend: .svg cannot hold it"),
    ("a.svg", {"styles": "flat", "moves": "jitter"}, "move"),
    ("a.ply", {"styles": "flat", "frames": "0-1"}, "write a_####.ply"),
    ("a.ply", {"styles": "edges"}, "edges: .ply cannot hold it"),
    ("a.ply", {"styles": ["flat", "gradient"]}, "one opaque style"),
    ("a.npz", {"styles": "flat", "scale": 2}, "pixels of the source"),
    ("a.csv", {"styles": "flat", "codec": "h264"}, "codec h264"),
    ("a.svg", {"styles": "flat", "svg_precision": 9}, "between 0 and 6"),
    ("a.stl", {"styles": "flat"}, ".csv"),
]


@pytest.mark.parametrize(("name", "options", "said"), REFUSED, ids=lambda v: str(v)[:30])
def test_what_cannot_be_held_is_told_in_one_line(
    track: Path, name: str, options: dict[str, object], said: str
) -> None:
    with pytest.raises(OptionError, match=re.escape(said)) as caught:
        trimotion.render(track, track.parent / "bad" / name, **{"frames": 0, **options})
    assert "\n" not in str(caught.value)


def test_an_unwritable_place_is_told_and_nothing_is_left(track: Path) -> None:
    with pytest.raises(OutputError, match="no folder"):
        trimotion.render(track, track.parent / "nowhere" / "a.svg", styles="flat", frames=0)
    assert not list(track.parent.glob(".trimotion-*"))
