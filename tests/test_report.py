"""`--report`: what came of a run, for programs and for people."""

import json
import os
import xml.etree.ElementTree as ElementTree
from base64 import b64decode
from collections.abc import Sequence
from pathlib import Path

import cv2
import jsonschema
import numpy as np
import pytest

import trimotion
from pipeline.cli import main
from pipeline.loop.animate import solve
from pipeline.progress import Progress
from pipeline.reporting.plot import MOST_POINTS, plot
from pipeline.stage_times import StageTimes, added
from stages.edits import split_triangles
from stages.metrics.changed_triangles import changed_triangles
from tests.jobs import job_of
from tests.meshes import random_mesh
from tests.tracks import COUNT, CUT, QUICK, QUICK_FLAGS, InTurn, write_clip

ROOT = Path(__file__).parents[1]
HTML = "{http://www.w3.org/1999/xhtml}"
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two shots, in a folder of their own."""
    return write_clip(tmp_path_factory.mktemp("report") / "clip.mp4")


def run(command: str, source: Path, output: Path, *flags: str) -> int:
    """A quick run that tells nothing."""
    quick = () if command == "render" else QUICK_FLAGS
    return main([command, str(source), "-o", str(output), *quick, "-q", *flags])


def read(path: Path) -> dict:
    """A report of JSON, held to its schema."""
    schema = json.loads((ROOT / "docs" / "report.schema.json").read_text("utf-8"))
    validator = jsonschema.Draft202012Validator(schema)
    validator.check_schema(schema)
    told = json.loads(path.read_text("utf-8"))
    validator.validate(told)
    assert not validator.is_valid({**told, "unknown": 1})
    assert not validator.is_valid({**told, "version": 2})
    return told


def test_json_of_animate_and_the_film_is_the_same(clip: Path, tmp_path: Path) -> None:
    """Every frame, the cut, the options that were given and those that were not."""
    assert run("animate", clip, tmp_path / "plain.mkv") == 0
    made = tmp_path / "told.mkv"
    assert run("animate", clip, made, "--report", str(tmp_path / "r.json")) == 0
    assert made.read_bytes() == (tmp_path / "plain.mkv").read_bytes()
    told = read(tmp_path / "r.json")
    frames = told["frames"]
    assert [one["frame"] for one in frames] == list(range(COUNT))
    assert [one["frame"] for one in frames if one["cut"]] == told["summary"]["cuts"] == [CUT]
    assert [one["frame"] for one in frames if one["changes"] is None] == [0, CUT]
    assert np.mean([one["rmse"] for one in frames]) == pytest.approx(told["summary"]["mean_rmse"])
    assert (told["options"]["triangles"], told["options"]["style"]) == (40, [])
    assert (told["options"]["no-audio"], told["options"]["crf"]) == (False, None)
    parts = sum(told["seconds_by_stage"].values())
    assert parts == pytest.approx(told["summary"]["seconds"], abs=0.05)
    assert {"trimotion", "numpy", "python"} <= told["versions"].keys()
    busy = told["busy_seconds"]
    assert {"decoding", "cuts, focus and motion", "solving", "drawing", "encoding"} <= busy.keys()
    assert 0 < busy["solving"] < told["summary"]["seconds"]
    assert told["peak_memory"]["process"] > 2**25
    assert told["peak_memory"]["largest_worker"] is None


def test_pages_of_a_solved_and_a_drawn_track(clip: Path, tmp_path: Path) -> None:
    """Both show pictures, plots and the cut, ask for nothing, and agree on every frame."""
    track = tmp_path / "t.mtrk"
    for ending in ("html", "json"):
        assert run("solve", clip, track, "--report", f"{tmp_path}/s.{ending}", "--overwrite") == 0
    still = tmp_path / "f_##.png"
    for ending in ("html", "json"):
        assert run("render", track, still, "--report", f"{tmp_path}/r.{ending}", "--overwrite") == 0
    solved, drawn = read(tmp_path / "s.json"), read(tmp_path / "r.json")
    kept = ("frame", "shot", "cut", "triangles", "rmse", "changes")
    assert [[a[k] for k in kept] for a in solved["frames"]] == [
        [b[k] for k in kept] for b in drawn["frames"]
    ]
    for page in ("s.html", "r.html"):
        _check_page((tmp_path / page).read_text("utf-8"))


def _check_page(text: str) -> None:
    root = ElementTree.fromstring(text)
    images = [image.attrib["src"] for image in root.iter(f"{HTML}img")]
    assert len(images) == 8
    for source in images:
        jpeg = b64decode(source.removeprefix("data:image/jpeg;base64,"))
        assert len(jpeg) < 20_000
        assert cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR).std() > 5
    plots = list(root.iter(f"{SVG}svg"))
    assert [p.findtext(f"{SVG}title") for p in plots][:2] == ["Triangles", "rmse [code values]"]
    for one in plots:
        kinds = [path.attrib["class"] for path in one.iter(f"{SVG}path")]
        assert kinds.count("cut") == 1
        assert "line" in kinds
    assert not list(root.iter(f"{HTML}script"))
    linked = [v for e in root.iter() for k, v in e.attrib.items() if k in ("src", "href")]
    assert all(value.startswith("data:") for value in linked)


def test_one_frame_has_figures_and_a_picture_of_its_own_size(clip: Path, tmp_path: Path) -> None:
    """A plot of one frame would be empty, and a small picture blown up."""
    flags = ("--frames", "3", "--report", f"{tmp_path}/r.html")
    assert run("animate", clip, tmp_path / "out.png", *flags) == 0
    root = ElementTree.fromstring((tmp_path / "r.html").read_text("utf-8"))
    (image,) = root.iter(f"{HTML}img")
    (figure,) = root.iter(f"{HTML}figure")
    assert image.attrib["width"] == "96"
    assert figure.attrib["style"] == "max-width: 96px"
    assert not list(root.iter(f"{SVG}svg"))
    rows = {row.findtext(f"{HTML}th"): row.findtext(f"{HTML}td") for row in root.iter(f"{HTML}tr")}
    assert rows["frame"] == "3"
    assert {"triangles", "rmse"} <= rows.keys()


def test_names_of_strangers_are_no_markup(clip: Path, tmp_path: Path) -> None:
    """What a file is called stands in the page as text, and shapes have no pictures."""
    odd = tmp_path / "<b>&'\x1b[31m.mp4"
    os.symlink(clip, odd)
    made = tmp_path / "s_##.svg"
    assert run("animate", odd, made, "--frames", "0-1", "--report", f"{tmp_path}/r.html") == 0
    root = ElementTree.fromstring((tmp_path / "r.html").read_text("utf-8"))
    cells = [cell.text or "" for cell in root.iter(f"{HTML}td")]
    assert any(cell.endswith("<b>&'\\x1b[31m.mp4") for cell in cells)
    assert not list(root.iter(f"{HTML}b"))
    assert not list(root.iter(f"{HTML}img"))


def test_ranges_are_told_together(clip: Path, tmp_path: Path) -> None:
    """Shots that were solved apart come in order, and only a report keeps figures."""
    job = job_of(clip, track=tmp_path / "a.mtrk", triangulate=QUICK, report="r.json")
    told = solve(job.solve, job.output, job.run, Progress(), runner=InTurn())
    assert [one.frame for one in told.figures] == list(range(COUNT))
    assert told.memory_apart == pytest.approx(told.memory, rel=0.05)  # here it is the same process
    assert told.busy["solving"] > 0
    job = job_of(clip, track=tmp_path / "b.mtrk", triangulate=QUICK)
    assert solve(job.solve, job.output, job.run, Progress()).figures == ()


REFUSED: list[tuple[str, Sequence[str], int, str]] = [
    ("r.txt", (), 2, "ends with neither .json nor .html"),
    (".html", (), 2, "is an ending without a name; write "),
    ("-", (), 2, "ends with neither .json nor .html"),
    ("there.json", (), 4, "exists already; choose another name or --overwrite"),
    ("none/r.json", (), 4, "there is no folder"),
    ("folder.json", ("--overwrite",), 4, "is a folder"),
    ("out.json", (), 2, "is read or written as well"),
    ("../{clip}/clip.html", (), 2, "is read or written as well"),
]


@pytest.mark.parametrize(("name", "more", "code", "words"), REFUSED)
def test_what_cannot_be_is_refused_at_once(
    name: str, more: Sequence[str], code: int, words: str, clip: Path, tmp_path: Path, capsys
) -> None:
    """One line, before any work: nothing else is there afterwards."""
    (tmp_path / "there.json").write_text("mine")
    (tmp_path / "folder.json").mkdir()
    source = clip
    if "{clip}" in name:
        source = clip.with_name("clip.html")
        if not source.exists():
            os.symlink(clip, source)
        name = os.path.relpath(source, tmp_path)
    before = sorted(os.listdir(tmp_path))
    report = name if name == "-" else str(tmp_path / name)
    assert run("animate", source, tmp_path / "out.json", "--report", report, *more) == code
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1
    assert sorted(os.listdir(tmp_path)) == before
    assert (tmp_path / "there.json").read_text() == "mine"


def test_several_inputs_share_no_report(clip: Path, tmp_path: Path, capsys) -> None:
    """Each would replace the one before."""
    flags = ("-o", f"{tmp_path}/out/", "--report", f"{tmp_path}/r.json")
    os.symlink(clip, tmp_path / "other.mp4")
    assert main(["animate", str(clip), f"{tmp_path}/other.mp4", *flags]) == 2
    assert "several inputs" in capsys.readouterr().err


def test_a_failed_run_leaves_no_report(tmp_path: Path) -> None:
    """Nothing came of it."""
    (tmp_path / "bad.mp4").write_text("no film")
    report = tmp_path / "r.json"
    assert run("animate", tmp_path / "bad.mp4", tmp_path / "o.mp4", "--report", str(report)) == 3
    assert not report.exists()


def test_a_call_reports_as_well(clip: Path, tmp_path: Path) -> None:
    """The keyword is the option; its sentences name keywords."""
    options = {"triangles": 40, "iterations": 8, "frame_iterations": 4, "frames": "0-2"}
    trimotion.animate(clip, tmp_path / "o.gif", report=tmp_path / "r.json", **options)
    told = read(tmp_path / "r.json")
    assert (len(told["frames"]), told["options"]["frames"]) == (3, "0-2")
    assert not any("--" in note for note in told["notes"])


def test_stages_take_what_they_do_themselves() -> None:
    """What a stage waits for from another one is the other's, also where they are generators."""
    clock = iter(range(100))
    times = StageTimes(lambda: next(clock))
    frames = times.over("decoding", [1, 2])
    with times.spent("drawing"), times.spent("encoding"):
        pass
    assert times.seconds == {"encoding": 1, "drawing": 2}  # looked at thrice in a row
    assert list(times.over("solving", (frame + 1 for frame in frames))) == [2, 3]
    assert times.seconds["decoding"] == 3  # two frames, and finding no third
    assert times.seconds["solving"] == 6
    assert added([{"a": 1.0}, {"a": 2.0, "b": 3.0}]) == {"a": 3.0, "b": 3.0}


def test_changed_triangles_are_counted() -> None:
    """None of a mesh that moves; the parts of what is split."""
    mesh = random_mesh(3)
    assert changed_triangles(mesh, mesh.moved(mesh.vertices * 1.0)) == 0
    shuffled = split_triangles(mesh, np.array([4]))
    by_hand = {tuple(sorted(mesh.vertex_ids[t])) for t in mesh.triangles}
    after = [tuple(sorted(shuffled.vertex_ids[t])) for t in shuffled.triangles]
    assert changed_triangles(mesh, shuffled) == sum(one not in by_hand for one in after) > 1


def test_a_long_film_is_a_short_line() -> None:
    """Extremes stay, points are few; gaps and lone frames are drawn."""
    values: list[float | None] = [1.0] * 50_000
    values[31_234], values[10], values[12] = 9.0, None, None
    drawn = plot("t", range(50_000), values, [7])
    assert len(drawn) < 30 * MOST_POINTS
    assert ">9</text>" in drawn
    assert "h1" in drawn
    assert " 10.0" in drawn
    assert plot("t", [5], [None], []).count("line") == 0
