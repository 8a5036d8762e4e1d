"""Several inputs, or a folder: one output each, whatever becomes of the others."""

import json
import subprocess
import sys
from pathlib import Path

import cv2
import media_samples as samples
import pytest

from pipeline.cli import main
from pipeline.commands.batch import batch_of
from pipeline.commands.inputs import joined
from stages.media import probe
from tests.test_cli import ROOT
from warp_kernels.errors import OptionError

QUICK = ["--triangles", "20", "--iterations", "2", "--frame-iterations", "1"]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A clip, a still, what is neither, and what only pretends to be one."""
    inside = tmp_path / "in"
    (inside / "deeper").mkdir(parents=True)
    samples.write_video(inside / "b.mp4", [samples.picture(32, 24, n) for n in range(2)])
    samples.write_still(inside / "a10.png", samples.picture(32, 24))
    samples.write_still(inside / "a2.png", samples.picture(32, 24))
    (inside / "broken.mov").write_text("no film")
    (inside / "notes.txt").write_text("nothing")
    (inside / ".hidden.png").write_text("nothing")
    return inside


def refused(capsys: pytest.CaptureFixture, *arguments: str, code: int = 2) -> str:
    """The one line with which a command ends."""
    assert main(arguments) == code
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    return captured.err


def test_a_folder_becomes_a_folder(folder: Path, tmp_path: Path, capsys) -> None:
    """One output each, in the order of their numbers; the broken one is told and costs no other."""
    out = tmp_path / "new" / "out"
    assert main(["animate", str(folder), "-o", f"{out}/", *QUICK, "--progress", "plain"]) == 3
    assert sorted(path.name for path in out.iterdir()) == ["a10.png", "a2.png", "b.mp4"]
    lines = capsys.readouterr().err.splitlines()
    begun = [line for line in lines if line.startswith(("1/", "2/", "3/", "4/"))]
    assert [Path(line).name for line in begun] == ["a2.png", "a10.png", "b.mp4", "broken.mov"]
    assert "left out: notes.txt" in lines[0]
    assert lines[-1].startswith("3 of 4 done, 4 frames in ")
    assert lines[-1].endswith(f"failed: {folder / 'broken.mov'}")


def test_programs_are_told(folder: Path, tmp_path: Path, capsys) -> None:
    """Which file begins, and in the end what failed."""
    names = [str(folder / name) for name in ("a2.png", "broken.mov")]
    command = ["animate", *names, "-o", f"{tmp_path}/out/", *QUICK, "--progress", "json"]
    assert main(command) == 3
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    begun = [event for event in events if event["event"] == "file"]
    assert [(event["number"], event["total"]) for event in begun] == [(1, 2), (2, 2)]
    assert [event["source"] for event in begun] == names
    assert events[-1] == {"event": "all done", "frames": 1, "failed": names[1:], "code": 3}


def test_tracks_and_what_is_drawn_of_them(folder: Path, tmp_path: Path) -> None:
    """`solve` and `render` alike; the track of a still becomes a still."""
    names = [str(folder / name) for name in ("b.mp4", "a2.png")]
    tracks, films = tmp_path / "tracks", tmp_path / "films"
    quiet = ["--progress", "none"]
    assert main(["solve", *names, "-o", f"{tracks}/", *QUICK, *quiet]) == 0
    assert sorted(path.name for path in tracks.iterdir()) == ["a2.mtrk", "b.mtrk"]
    assert main(["render", str(tracks), "-o", f"{films}/", *quiet]) == 0
    assert sorted(path.name for path in films.iterdir()) == ["a2.png", "b.mp4"]


def test_what_exists_already_is_kept(folder: Path, tmp_path: Path, capsys) -> None:
    """A batch that was interrupted is begun again: what is there stays, the rest is done."""
    names = [str(folder / name) for name in ("a2.png", "a10.png")]
    out = tmp_path / "out"
    out.mkdir()
    (out / "a2.png").write_bytes(b"old")
    assert main(["animate", *names, "-o", str(out), *QUICK]) == 4
    assert (out / "a2.png").read_bytes() == b"old"
    assert (out / "a10.png").exists()
    assert "exists already" in capsys.readouterr().err


def test_mistakes_are_told_before_work_begins(folder: Path, tmp_path: Path, capsys) -> None:
    """Nothing is written, no folder made."""
    names = [str(folder / name) for name in ("a2.png", "a10.png")]
    assert "such as out/" in refused(capsys, "animate", *names, "-o", str(tmp_path / "o.mp4"))
    assert f"{tmp_path}/o/" in refused(capsys, "animate", str(folder), "-o", str(tmp_path / "o"))
    line = refused(capsys, "animate", *names, names[0], "-o", f"{tmp_path}/o/")
    assert "a2.png: is named 2 times; name it once" in line
    assert "pipe" in refused(capsys, "animate", names[0], "-", "-o", f"{tmp_path}/o/")
    line = refused(capsys, "animate", str(folder / "deeper"), "-o", f"{tmp_path}/o/", code=3)
    assert "holds no film or picture" in line
    assert "holds no mesh track" in refused(
        capsys, "render", str(folder), "-o", f"{tmp_path}/o/", code=3
    )
    track = ["--track", str(tmp_path / "t.mtrk")]
    assert "--track" in refused(capsys, "animate", *names, "-o", f"{tmp_path}/o/", *track)
    assert "side by side" in refused(capsys, "animate", "a.mp4", "-o", "b.mp4", "c.mp4")
    assert not (tmp_path / "o").exists()


@pytest.mark.parametrize("command", ["animate", "solve"])
def test_a_mistake_that_all_share_is_told_once(
    command: str, folder: Path, tmp_path: Path, capsys
) -> None:
    """Not once for each input, and no folder is made for it."""
    preset = tmp_path / "wrong.toml"
    preset.write_text('triangles = "many"')
    names = [str(folder / name) for name in ("a2.png", "b.mp4")]
    out = tmp_path / "out"
    told = refused(capsys, command, *names, "-o", f"{out}/", "--preset", str(preset))
    assert "triangles" in told
    assert not out.exists()


def test_one_input_has_its_folder_made_too(folder: Path, tmp_path: Path, capsys) -> None:
    """As several have it: `*.mp4` may match one file. Where nothing came to be none is left."""
    quiet = [*QUICK, "--progress", "none"]
    out = tmp_path / "new" / "out"
    assert main(["animate", str(folder / "a2.png"), "-o", f"{out}/", *quiet]) == 0
    assert main(["preview", str(folder / "a2.png"), "-o", f"{out}/look/", *quiet]) == 0
    assert [path.name for path in (out / "look").iterdir()] == ["a2.preview.png"]
    gone = tmp_path / "gone"
    for inputs in ([folder / "broken.mov"], [folder / "broken.mov", folder / "b.mov"]):
        assert main(["animate", *map(str, inputs), "-o", f"{gone}/deep/", *quiet]) == 3
        assert not gone.exists()
    capsys.readouterr()
    refused(capsys, "animate", str(folder / "b.mp4"), "-o", f"{folder}/notes.txt/", code=4)


def test_tracks_beside_outputs_have_their_folder_made(folder: Path, tmp_path: Path) -> None:
    """For several inputs and for one; without any, none is left."""
    names = [str(folder / name) for name in ("b.mp4", "a2.png")]
    tracks = tmp_path / "tracks"
    for inputs, code in ((names, 0), (names[:1], 0), ([str(folder / "broken.mov")], 3)):
        more = ["-o", f"{tmp_path}/o{code}/", "--track", f"{tracks}{code}/", "--overwrite"]
        assert main(["animate", *inputs, *more, *QUICK, "--progress", "none"]) == code
    assert sorted(path.name for path in Path(f"{tracks}0").iterdir()) == ["a2.mtrk", "b.mtrk"]
    assert not Path(f"{tracks}3").exists()


@pytest.mark.parametrize(("first", "second"), [("a.avi", "a.mp4"), ("x/c.mov", "y/c.mov")])
def test_two_that_would_have_one_name(first: str, second: str, tmp_path: Path) -> None:
    """By their endings or their folders; names that differ by their endings alone are two."""
    with pytest.raises(OptionError, match="all would become"):
        batch_of("animate", [first, second], f"{tmp_path}/o/")
    with pytest.raises(OptionError, match="all would become"):
        batch_of("solve", ["a.mp4", "a.mov"], f"{tmp_path}/o/")
    batch = batch_of("animate", ["a.mp4", "a.mov"], f"{tmp_path}/o/")
    assert batch is not None
    assert [item.output.name for item in batch.items] == ["a.mp4", "a.mov"]


def test_numbered_stills_of_a_folder_are_told(tmp_path: Path) -> None:
    """They are pictures, as those of a camera are; the note says how they are a clip."""
    for number in range(8, 18):
        (tmp_path / f"f_{number:03}.jpg").touch()
    batch = batch_of("animate", [str(tmp_path)], f"{tmp_path}/o/")
    assert batch is not None
    assert len(batch.items) == 10
    assert any(note.endswith(f"{tmp_path}/f_###.jpg") for note in batch.notes)


def test_one_input_is_no_batch(folder: Path) -> None:
    """Nor is a pattern."""
    assert batch_of("animate", ["s_####.png"], "o.mp4") is None
    assert batch_of("render", [str(folder / "b.mtrk")], "o/") is None


def test_piped_still_is_a_still(folder: Path, tmp_path: Path) -> None:
    """Also where a folder is named, and where no format is."""
    content = (folder / "a2.png").read_bytes()
    program = [sys.executable, "-m", "pipeline.cli", "animate"]
    subprocess.run(
        [*program, "-", "-o", f"{tmp_path}/", *QUICK], cwd=ROOT, input=content, check=True
    )
    assert probe(tmp_path / "standard input.png").kind == "image"
    command = [*program, str(folder / "a2.png"), *QUICK]
    run = subprocess.run([*command, "-o", "-"], cwd=ROOT, capture_output=True, check=True)
    assert run.stdout.startswith(b"\x89PNG")
    (tmp_path / "o.png").write_bytes(run.stdout)
    assert cv2.imread(str(tmp_path / "o.png")).shape == (24, 32, 3)


def test_track_through_a_pipe(folder: Path, tmp_path: Path, monkeypatch, capsys) -> None:
    """What `solve -o -` writes `render -` draws; no command calls a track damaged."""
    track, still = tmp_path / "t.mtrk", tmp_path / "o.png"
    quiet = ["--progress", "none"]
    assert main(["solve", str(folder / "a2.png"), "-o", str(track), *QUICK, *quiet]) == 0
    for command in (["preview", str(track)], ["measure", str(folder / "a2.png"), str(track)]):
        assert main(command) == 3
        assert "is a mesh track" in capsys.readouterr().err
    with track.open() as file:
        # real need: standard input is the whole process's
        monkeypatch.setattr(sys, "stdin", file)
        assert main(["render", "-", "-o", str(still), *quiet]) == 0
    assert probe(still).kind == "image"


def test_errors_of_pipes_name_them(folder: Path, tmp_path: Path, monkeypatch, capsys) -> None:
    """Nobody knows the temporary files in their place."""
    with (folder / "broken.mov").open() as file:
        # real need: standard input is the whole process's
        monkeypatch.setattr(sys, "stdin", file)
        line = refused(capsys, "animate", "-", "-o", str(tmp_path / "o.mp4"), code=3)
    assert line.startswith("trimotion: error: -: not a readable media file")
    line = refused(capsys, "animate", str(folder / "b.mp4"), "-o", "-.xyz")
    assert line.startswith("trimotion: error: output -.xyz: files of ending")
    assert "error: -o -: " in refused(capsys, "animate", str(folder), "-o", "-")
    assert "one file" in refused(capsys, "render", "-", "--source", "-", "-o", "o.mp4")


@pytest.mark.parametrize(
    ("given", "read"),
    [
        ("animate a -o -.png", "animate a -o-.png"),
        ("animate a --output -.gif -q", "animate a --output=-.gif -q"),
        ("animate a -o - -q", "animate a -o- -q"),
        ("animate a -o -q", "animate a -o -q"),
        ("animate - -o b", "animate - -o b"),
    ],
)
def test_formats_of_pipes_may_stand_apart(given: str, read: str) -> None:
    """`-.png` looks like an option to a parser, and like a name to people."""
    assert joined(given.split()) == read.split()
