"""DXF holds what a cutter follows: millimetres, y up, a layer a colour, each edge once."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf.document import Drawing
from meshes import random_mesh
from PIL import Image

import trimotion
from stages.exchange.plane.trails import trails_of
from trimotion import OptionError

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def track(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A frame of 96 x 64 in 24 triangles."""
    folder = tmp_path_factory.mktemp("dxf")
    blobs = np.random.default_rng(5).integers(0, 256, (4, 6, 3), dtype=np.uint8)
    Image.fromarray(blobs).resize((96, 64)).save(folder / "in.png")
    trimotion.solve(folder / "in.png", folder / "in.mtrk", triangles=24, iterations=3)
    return folder / "in.mtrk"


def written(track: Path, **options: object) -> Drawing:
    target = track.parent / "out.dxf"
    trimotion.render(track, target, overwrite=True, **options)  # type: ignore[arg-type]
    drawing = ezdxf.readfile(target)
    assert not drawing.audit().errors
    assert drawing.units == ezdxf.units.MM
    return drawing


def lines_of(drawing: Drawing) -> Iterator[np.ndarray]:
    for line in drawing.modelspace().query("LWPOLYLINE"):
        yield np.array(list(line.get_points("xyb")))


def layers_of(drawing: Drawing) -> list[str]:
    return [layer.dxf.name for layer in drawing.layers if layer.dxf.name not in "0 Defpoints"]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_trails_go_along_every_edge_once_and_are_as_few_as_can_be(seed: int) -> None:
    mesh = random_mesh(seed=seed)
    trails = trails_of(mesh.edge_vertices, mesh.vertices)
    steps = np.concatenate([np.stack([one[:-1], one[1:]], axis=1) for one in trails])
    np.testing.assert_array_equal(
        np.unique(np.sort(steps, axis=1), axis=0), np.unique(np.sort(mesh.edge_vertices), axis=0)
    )
    assert len(steps) == mesh.edge_count
    odd = np.count_nonzero(np.bincount(mesh.edge_vertices.reshape(-1)) % 2)
    assert len(trails) == max(1, odd // 2)


def test_edges_are_cut_once_in_millimetres(track: Path) -> None:
    drawing = written(track, styles="edges:color=#f00", mm=192)
    assert layers_of(drawing) == ["edges-1-ff0000"]
    assert drawing.layers.get("edges-1-ff0000").rgb == (255, 0, 0)
    one = next(iter(trimotion.open_track(track)))
    wanted = 2.0 * np.stack([one.vertices[:, 0], 64 - one.vertices[:, 1]], axis=1)
    sides = one.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    wanted = wanted[np.unique(np.sort(sides), axis=0)]
    lines = [line[:, :2] for line in lines_of(drawing)]
    found = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
    assert len(found) == len(wanted)
    np.testing.assert_allclose(ordered(found), ordered(wanted), atol=1e-4)


def ordered(ends: np.ndarray) -> np.ndarray:
    """Middles and lengths of straight lines, sorted."""
    rows = np.round(ends, 4)
    middle = rows.mean(axis=1)
    lengths = np.hypot(*(rows[:, 1] - rows[:, 0]).T)
    table = np.column_stack([middle, lengths])
    return table[np.lexsort(np.round(table, 3).T)]


def test_triangles_have_their_colours_and_areas_a_layer_each(track: Path) -> None:
    one = next(iter(trimotion.open_track(track)))
    lines = list(written(track, styles="flat").modelspace())
    assert len(lines) == len(one.triangles)
    assert all(line.closed for line in lines)
    layers = layers_of(written(track, styles="flat", palette="#000,#fff:mode=nearest"))
    assert {name.split("-")[2] for name in layers} == {"000000", "ffffff"}
    merged = written(track, styles="flat", palette="#000,#fff:mode=nearest", svg_merge=True)
    loops = list(lines_of(merged))
    assert len(loops) < len(lines)
    # holes turn the other way round
    assert sum(area_of(loop[:, :2]) for loop in loops) == pytest.approx(-96 * 64, abs=0.1)


def area_of(points: np.ndarray) -> float:
    x, y = points.T
    return float(0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


def test_round_corners_are_arcs_around_the_inner_triangle(track: Path) -> None:
    sharp = list(lines_of(written(track, styles="shrink:rounding=0,gap=2")))
    for line, inner in zip(
        lines_of(written(track, styles="shrink:rounding=1,gap=2")), sharp, strict=True
    ):
        turns = 4 * np.arctan(line[:, 2])
        assert turns.sum() == pytest.approx(-2 * np.pi, abs=1e-3)
        # all of the triangle is round then: an incircle, and inner has the same centre
        corners = inner[:, :2]
        opposite = np.hypot(*(np.roll(corners, -1, axis=0) - np.roll(corners, 1, axis=0)).T)
        reach = np.hypot(*(line[:, :2] - opposite @ corners / opposite.sum()).T)
        np.testing.assert_allclose(reach, 2 * abs(area_of(corners)) / opposite.sum(), rtol=1e-3)


def test_circles_and_strokes_of_pens(track: Path) -> None:
    circles = written(track, styles="circles:gap=0").modelspace().query("CIRCLE")
    one = next(iter(trimotion.open_track(track)))
    assert len(circles) >= len(one.triangles)
    area = sum(np.pi * circle.dxf.radius**2 for circle in circles)
    assert 0.6 * 96 * 64 < area < 96 * 64
    drawing = written(track, styles="hatching:paper=none,ink=#00f", mm=96)
    assert layers_of(drawing) == ["hatching-1-0000ff"]
    svg = track.parent / "same.svg"
    trimotion.render(
        track, svg, styles="hatching:paper=none,ink=#00f", mm=96, frames=0, overwrite=True
    )
    assert len(drawing.modelspace().query("LINE")) == svg.read_text().count("M")


def test_the_same_input_gives_the_same_bits(track: Path) -> None:
    target = track.parent / "out.dxf"
    kept = ezdxf.options.write_fixed_meta_data_for_testing
    written(track, styles=["flat", "edges"])
    assert ezdxf.options.write_fixed_meta_data_for_testing == kept
    first = target.read_bytes()
    written(track, styles=["flat", "edges"])
    assert target.read_bytes() == first


REFUSED = [
    ({"styles": "gradient"}, r"gradient: \.dxf cannot hold it"),
    ({"styles": "flat:opacity=0.5"}, "opacity and blend"),
    ({"styles": "flat", "size": (64, 64), "fit": "cover"}, "use contain"),
    ({"styles": "flat", "size": (64, 64), "fit": "stretch"}, "use contain"),
]


@pytest.mark.parametrize(("options", "said"), REFUSED, ids=lambda one: str(one)[:40])
def test_what_it_cannot_hold_is_told_in_one_line(
    track: Path, options: dict[str, object], said: str
) -> None:
    target = track.parent / "bad.dxf"
    with pytest.raises(OptionError, match=said) as caught:
        trimotion.render(track, target, **options)  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)
    assert not target.exists()


def test_a_missing_library_is_told_in_one_line(track: Path) -> None:
    program = (
        "import sys; sys.modules['ezdxf'] = None; from pipeline.cli import main; sys.exit(main())"
    )
    target = track.parent / "none.dxf"
    command = [sys.executable, "-c", program, "render", str(track), "-o", str(target)]
    done = subprocess.run([*command, "--style", "flat"], capture_output=True, text=True, cwd=ROOT)
    assert done.returncode
    assert "pip install 'trimotion[dxf]'" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not target.exists()
