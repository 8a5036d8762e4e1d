"""The mesh track: stored and read to the bit, drawn as by `animate`; what is wrong is one line."""

import json
import shutil
import sqlite3
import tracemalloc
from contextlib import closing
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import cv2
import numpy as np
import pytest

from pipeline.cli import main
from pipeline.loop.animate import animate
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import TrackReader, TrackWriter
from pipeline.track.agreement import differing_flags
from pipeline.track.packing.plain import pack, unpack
from pipeline.track.plain_values import from_plain, to_plain
from stages.flows import FLOWS
from stages.layouts.importance import Importance
from stages.media import FrameRange
from stages.validate import assert_valid
from tests import media_samples as samples
from tests.bad_tracks import bomb
from tests.jobs import job_of
from tests.tracks import COUNT, QUICK, QUICK_FLAGS, rows_of, solve_to, write_clip
from warp_kernels.styles import STYLES


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The clip."""
    return write_clip(tmp_path_factory.mktemp("track") / "in.mp4")


@pytest.fixture(scope="module")
def track(clip: Path) -> Path:
    """Its track."""
    path = clip.with_name("whole.mtrk")
    solve_to(path, clip)
    return path


@pytest.fixture
def copy(track: Path, tmp_path: Path) -> Path:
    """A track that may be spoilt."""
    return Path(shutil.copy(track, tmp_path / "copy.mtrk"))


def failure(capsys, *arguments: object) -> tuple[int, str]:
    """Exit code and the one line of a command that fails."""
    code = main([*map(str, arguments)])
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert captured.err.startswith("trimotion: error: ")
    return code, captured.err


@pytest.mark.parametrize("kind", ["<f8", "<i4", "<i8"])
@pytest.mark.parametrize("shape", [(0, 2), (1,), (7, 3, 2)])
def test_blobs_keep_every_bit(kind: str, shape: tuple, rng: np.random.Generator) -> None:
    """Also of values that are no numbers; bytes that are missing or too many are an error."""
    array = np.frombuffer(rng.bytes(int(np.prod(shape)) * int(kind[2])), kind).reshape(shape)
    blob = pack(array, kind)
    back = unpack(blob, kind, shape)
    assert (back.tobytes(), back.shape, back.dtype) == (array.tobytes(), shape, np.dtype(kind))
    for bad in (blob[:-1], b"", pack(np.zeros(99), "<f8")):
        with pytest.raises(ValueError, match=r"bytes|rror"):
            unpack(bad, kind, shape)


def test_blobs_are_no_larger_than_they_are_said_to_be() -> None:
    """A hundred kilobytes that would become a hundred megabytes are not unpacked."""
    packed = bomb(100)
    tracemalloc.start()
    with pytest.raises(ValueError, match="instead of 24"):
        unpack(packed, "<f8", (3,))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 1 << 20


def test_options_survive_as_plain_values() -> None:
    """Of all depths and kinds, members of registries and arrays among them."""
    options = SolveOptions(
        Path("in.mp4"),
        frame_range=FrameRange(1, 9, 2, Fraction(1, 3)),
        layout=Importance(importance_map=np.arange(6.0).reshape(2, 3), even_share=0.25),
        flow=FLOWS["none"](),
        triangulate=QUICK,
    )
    back = from_plain(SolveOptions, json.loads(json.dumps(to_plain(options))))
    np.testing.assert_array_equal(back.layout.importance_map, options.layout.importance_map)
    assert back.layout.even_share == 0.25
    assert replace(back, layout=options.layout) == options


def test_any_frame_at_once(track: Path) -> None:
    """In any order, valid, with what the next frame depends on; and by key, not by search."""
    with TrackReader(track) as reader:
        for frame in (7, 0, 11, 7, 6):
            snapshot = reader.snapshot(frame)
            assert snapshot.frame_index == frame
            assert_valid(snapshot.mesh)
            assert reader.rows[frame].rmse == snapshot.rmse
            assert reader.rows[frame].triangle_count == snapshot.mesh.triangle_count
    with closing(sqlite3.connect(track)) as connection:
        steps = connection.execute(
            "EXPLAIN QUERY PLAN SELECT * FROM frames JOIN meshes USING (frame) JOIN topologies"
            " ON topologies.frame = frames.topology WHERE frames.frame = 7"
        ).fetchall()
    assert len(steps) == 3
    assert all("USING INTEGER PRIMARY KEY" in step[-1] for step in steps)


@pytest.mark.parametrize("style", STYLES)
def test_track_is_drawn_as_by_animate(style: str, clip: Path, track: Path, tmp_path: Path) -> None:
    """Every style, bit for bit; a range and another size as well."""
    frames = "2-4" if style == "flat" else "6-7"
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    look = ["--style", style, "--scale", "1.5", "--frames", frames, "--progress", "none"]
    wanted = tmp_path / "a" / "f_##.png"
    solved = tmp_path / "solved.mtrk"
    # A range that starts inside a shot is another solution: it has a track of its own.
    more = ["--track", str(solved), *QUICK_FLAGS] if style == "flat" else [*QUICK_FLAGS]
    assert main(["animate", str(clip), "-o", str(wanted), *look, *more]) == 0
    source = solved if style == "flat" else track
    assert main(["render", str(source), "-o", str(tmp_path / "b" / "f_##.png"), *look]) == 0
    names = sorted(path.name for path in wanted.parent.iterdir())
    assert len(names) == 3 if style == "flat" else 2
    for name in names:
        drawn = [(tmp_path / folder / name).read_bytes() for folder in ("a", "b")]
        assert drawn[0] == drawn[1]


def test_track_without_its_source(track: Path, tmp_path: Path, capsys) -> None:
    """Looks that need no source are drawn without sound; others name what is missing."""
    alone = tmp_path / "alone.mtrk"
    clip = write_clip(tmp_path / "gone.mp4")
    solve_to(alone, clip, "0-2")
    moved = clip.rename(tmp_path / "moved.mp4")
    render = ["render", alone, "-o", tmp_path / "out.mp4"]
    assert main([*map(str, render)]) == 0
    assert "the sound is left out" in capsys.readouterr().err
    gradient = [*render, "--overwrite", "--style", "gradient", "--progress", "none"]
    code, line = failure(capsys, *gradient)
    assert (code, line.count("--source")) == (3, 1)  # the remedy stood there twice
    assert main([*map(str, gradient), "--source", str(moved)]) == 0
    moved.write_bytes(moved.read_bytes()[:-1] + b"x")
    code, line = failure(capsys, *gradient, "--source", moved)
    assert code == 3
    assert "is not the source that the track was made from" in line


def test_info_tells_what_a_track_is(track: Path, clip: Path, capsys) -> None:
    """Lines for people; JSON with all that proves how it was made."""
    assert main(["info", str(track)]) == 0
    lines = capsys.readouterr().out
    assert "0 to 11, 12 in all" in lines
    assert "2, from frames 0, 6" in lines
    assert main(["info", str(track), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["options"]["triangulate"]["refine"]["triangles"] == 40
    assert facts["source"]["size"] == clip.stat().st_size
    assert facts["finished"]
    assert [row["frame"] for row in facts["frames"]] == list(range(COUNT))


def test_every_shot_brings_its_topology(track: Path, tmp_path: Path) -> None:
    """Even one that is equal to that of the shot before: parts of a track stand alone."""
    with TrackReader(track) as reader:
        header, snapshot = reader.header, reader.snapshot(0)
    with TrackWriter(tmp_path / "t.mtrk", header) as writer:
        for frame, shot in enumerate((0, 0, 2, 2)):
            writer.write(replace(snapshot, frame_index=frame, pts=frame), shot)
    assert [row[0] for row in rows_of(tmp_path / "t.mtrk")["topologies"]] == [0, 2]


def test_a_stranger_commands_no_terminal(copy: Path, capsys) -> None:
    """What a track says is printed without control characters, in descriptions and in errors."""
    spoil(copy, "UPDATE header SET value = '\"\\u001b[31m9\"' WHERE key = 'program'")
    assert main(["info", str(copy)]) == 0
    assert "by trimotion \\x1b[31m9" in capsys.readouterr().out
    spoil(copy, "UPDATE header SET value = '\"\\u001b[31m9\"' WHERE key = 'model'")
    assert "\x1b" not in failure(capsys, "info", copy)[1]


@pytest.mark.parametrize("name", ["x" * 5000, "a##/b##.png", "con/\u202e.mp4", "/", ""])
def test_source_of_any_name(name: str, copy: Path, tmp_path: Path) -> None:
    """Where the source was is a stranger's text, too: what needs no source is drawn without."""
    with closing(sqlite3.connect(copy, isolation_level=None)) as connection:
        (text,) = connection.execute("SELECT value FROM header WHERE key = 'source'").fetchone()
        text = json.dumps({**json.loads(text), "path": name})
        connection.execute("UPDATE header SET value = ? WHERE key = 'source'", (text,))
    assert main(["render", str(copy), "-o", str(tmp_path / "a.mp4"), "--frames", "0-1", "-q"]) == 0


def write_stills(folder: Path, pictures: list[np.ndarray]) -> Path:
    """Numbered stills, to the bit."""
    folder.mkdir()
    for number, pixels in enumerate(pictures):
        cv2.imwrite(str(folder / f"f_{number:02d}.png"), pixels[..., ::-1])
    return folder / "f_##.png"


def test_same_picture_keeps_its_mesh(tmp_path: Path) -> None:
    """What is drawn for every other frame moves with every other frame alone.

    A mesh is not at rest after the few iterations of a frame: solved again, it would change. Where
    the map of weights changes the picture is another one.
    """
    pictures = [samples.picture(96, 64, number // 2) for number in range(6)]
    clip = write_stills(tmp_path / "clip", pictures)
    greys = [np.full((64, 96, 3), 50 + 40 * (number % 2), np.uint8) for number in range(6)]
    for number, grey in enumerate(greys):
        grey[: 10 * number + 5] = 255
    weights = str(write_stills(tmp_path / "weights", greys))
    for name, options, keeps in (("a", {}, True), ("b", {"weights": weights}, False)):
        track = tmp_path / f"{name}.mtrk"
        solve_to(track, clip, **options)
        with TrackReader(track) as reader:
            meshes = [reader.snapshot(number).mesh for number in range(6)]
        for number in range(1, 6):
            before, after = meshes[number - 1], meshes[number]
            same = np.array_equal(before.vertices, after.vertices)
            assert same == (keeps and number % 2 == 1)


def test_stills_have_tracks(tmp_path: Path, clip: Path) -> None:
    """A picture becomes a track of one frame."""
    one = FrameRange(0, 0)
    animate(job_of(clip, tmp_path / "a.png", frame_range=one, triangulate=QUICK), Progress())
    solve_to(tmp_path / "a.mtrk", tmp_path / "a.png")
    assert main(["render", str(tmp_path / "a.mtrk"), "-o", str(tmp_path / "b.png"), "-q"]) == 0


def spoil(path: Path, how: str) -> Path:
    """Damage a track."""
    if how == "empty":
        path.write_bytes(b"")
    elif how == "text":
        path.write_text("no track" * 99)
    elif how == "cut off":
        path.write_bytes(path.read_bytes()[:-5000])
    elif how == "page":
        content = bytearray(path.read_bytes())
        content[4096:8192] = b"\xff" * 4096
        path.write_bytes(content)
    else:
        with closing(sqlite3.connect(path, isolation_level=None)) as connection:
            connection.execute(how)
    return path


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ("empty", "is no mesh track"),
        ("text", "is no mesh track"),
        ("cut off", "is cut off"),
        ("page", "damaged"),
        ("PRAGMA application_id = 7", "is no mesh track"),
        ("PRAGMA user_version = 99", "format 99, and this program reads formats up to 2"),
        ("DROP TABLE header", "damaged"),
        ("DELETE FROM header WHERE key = 'source'", "header is damaged"),
        ("UPDATE header SET value = '[' WHERE key = 'options'", "header is damaged"),
        ("UPDATE meshes SET vertices = zeroblob(9)", "frame 0 is damaged"),
        ("UPDATE topologies SET triangles = (SELECT counts FROM meshes)", "frame 0 is damaged"),
        ("DELETE FROM frames", "holds no frame"),
    ],
)
def test_spoilt_track_is_one_line(how: str, words: str, copy: Path, tmp_path: Path, capsys) -> None:
    """Exit code 3, the file and what to do; nothing is written."""
    spoil(copy, how)
    code, line = failure(capsys, "render", copy, "-o", tmp_path / "out.mp4", "--progress", "none")
    assert code == 3
    assert words in line
    assert f"{copy}: " in line
    assert ";" in line
    assert list(tmp_path.iterdir()) == [copy]


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (("--triangles", "41"), 2, "--triangles 41 instead of 40"),
        (("--flow", "none"), 2, "--flow none instead of dis"),
        (("--seed", "3", "--independent"), 2, "--seed 3 instead of 0"),
        (("--cuts", "none"), 2, "--cuts none instead of auto"),
        (("--frames", "0-x2"), 2, "every 2. frame"),
        (("--frames", "20-"), 2, "go on with --frames 12-"),
    ],
)
def test_other_options_are_no_resumption(
    options: tuple, code: int, words: str, clip: Path, copy: Path, capsys
) -> None:
    """The options that differ are named, and the track stays as it is."""
    before = copy.read_bytes()
    flags = [*QUICK_FLAGS, *options, "--resume", "--progress", "none"]
    found, line = failure(capsys, "solve", clip, "-o", copy, *flags)
    assert (found, copy.read_bytes()) == (code, before)
    assert words in line


def test_track_of_a_program_that_knew_less_goes_on(copy: Path) -> None:
    """What it could not say of focus and of reading is what it did: nothing special."""
    with TrackReader(copy) as track:
        wanted = {**track.header.options, "focus": [{"class": "none"}]}
    known = {name: value for name, value in wanted.items() if name not in ("focus", "read")}
    with closing(sqlite3.connect(copy)) as connection:
        statement = "UPDATE header SET value = ? WHERE key = 'options'"
        connection.execute(statement, (json.dumps(known),))
        connection.commit()
    with TrackReader(copy) as track:
        assert not differing_flags(wanted, track.header.options)
        found = differing_flags({**wanted, "focus": []}, track.header.options)
        assert found == ["--focus none instead of auto"]


def test_other_versions_are_told(clip: Path, copy: Path) -> None:
    """A track goes on with another NumPy, but it does so openly."""
    spoil(copy, "UPDATE header SET value = '{\"numpy\": \"0.1\"}' WHERE key = 'libraries'")
    notes = solve_to(copy, clip, resume=True).notes
    assert any(f"numpy {np.__version__} instead of 0.1" in note for note in notes)


def test_other_source_is_no_resumption(clip: Path, copy: Path, tmp_path: Path, capsys) -> None:
    """A source that changed since, in its size or in its content."""
    content = clip.read_bytes()
    other = tmp_path / "other.mp4"
    for changed in (content + b"\0", content[:-1] + b"\1"):
        other.write_bytes(changed)
        flags = [*QUICK_FLAGS, "--resume", "--progress", "none"]
        code, line = failure(capsys, "solve", other, "-o", copy, *flags)
        assert code == 3
        assert "is not the source that the track was made from" in line


def test_cuts_beyond_the_clip(clip: Path, tmp_path: Path, capsys) -> None:
    """The list is another clip's; the last frame is named."""
    cuts = tmp_path / "cuts.txt"
    cuts.write_text(f"6\n{COUNT}\n")
    for command in ("animate", "solve", "plan"):
        out = (
            [] if command == "plan" else ["-o", tmp_path / f"{command}.mtrk", "--progress", "none"]
        )
        out = ["-o", tmp_path / "o.mp4", "--progress", "none"] if command == "animate" else out
        code, line = failure(capsys, command, clip, *out, "--cuts", cuts)
        assert code == 3
        assert f"a cut at frame {COUNT}" in line
        assert f"ends with frame {COUNT - 1}" in line
    assert list(tmp_path.iterdir()) == [cuts]


def test_existing_tracks_are_kept(clip: Path, copy: Path, tmp_path: Path, capsys) -> None:
    """Without --resume or --overwrite; a bad range does not replace it even then."""
    before = copy.read_bytes()
    quiet = ("--progress", "none", *QUICK_FLAGS)
    assert failure(capsys, "solve", clip, "-o", copy, *quiet)[0] == 4
    beyond = ("--frames", "99-", "--overwrite")
    assert failure(capsys, "solve", clip, "-o", copy, *quiet, *beyond)[0] == 2
    assert failure(capsys, "solve", clip, "-o", tmp_path / "a.mp4", *quiet)[0] == 2
    assert failure(capsys, "solve", clip, "-o", tmp_path / "no" / "a.mtrk", *quiet)[0] == 4
    assert failure(capsys, "animate", clip, "-o", tmp_path / "a.mp4", "--resume", *quiet)[0] == 2
    assert copy.read_bytes() == before
    assert main(["solve", str(clip), "-o", str(copy), *quiet, "--overwrite", "--frames", "0"]) == 0
    with TrackReader(copy) as reader:
        assert len(reader.rows) == 1


def test_parts_that_do_not_fit(clip: Path, track: Path, tmp_path: Path, capsys) -> None:
    """Overlaps, gaps, other options, unfinished parts, and outputs that exist."""
    ranges = {"a": "0-2", "b": "3-4", "c": "6-7"}
    parts = {name: tmp_path / f"{name}.mtrk" for name in ranges}
    for name, frames in ranges.items():
        solve_to(parts[name], clip, frames)
    other = tmp_path / "other.mtrk"
    solve_to(other, clip, "3-4", seed=1)
    out = tmp_path / "out.mtrk"
    for names, code, words in (
        ((parts["a"], track), 2, "do not overlap"),
        ((parts["a"], parts["b"], parts["c"]), 2, "frames 5 to 5 are missing"),
        ((parts["a"], other), 3, "--seed 1 instead of 0"),
        ((parts["a"], tmp_path / "none.mtrk"), 3, "none.mtrk"),
    ):
        found, line = failure(capsys, "join", *names, "-o", out)
        assert found == code
        assert words in line
        assert not out.exists()
    assert failure(capsys, "join", parts["a"], parts["b"], "-o", parts["b"])[0] == 2
    assert failure(capsys, "join", parts["a"], parts["b"], "-o", other)[0] == 4
    spoil(parts["b"], "UPDATE header SET value = 'false' WHERE key = 'finished'")
    assert "is unfinished" in failure(capsys, "join", parts["a"], parts["b"], "-o", out)[1]


def test_two_writers_do_not_mix(track: Path, copy: Path, capsys) -> None:
    """A frame that stands there already is not written twice."""
    with TrackReader(track) as reader:
        last, header = reader.snapshot(4), reader.header
    with (
        TrackWriter.resume(copy, header, last, 0) as writer,
        pytest.raises(Exception, match="one run"),
    ):
        writer.write(replace(last, frame_index=5), 0)
