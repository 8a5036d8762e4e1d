"""`animate`, `solve`, `render` and `measure` as functions: what the commands do."""

import asyncio
import gc
import logging
import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import trimotion
from pipeline.cli import main
from pipeline.track import TrackReader
from tests.tracks import COUNT, CUT, QUICK_FLAGS, rows_of, write_clip
from warp_kernels.device.device import Device

QUICK: trimotion.SolveKeywords = {"iterations": 8, "frame_iterations": 4, "triangles": 40}


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Twelve frames in two shots, 96x64."""
    return write_clip(tmp_path_factory.mktemp("clip") / "clip.mkv")


def test_animate_writes_what_the_command_writes(clip: Path, tmp_path: Path, capfd) -> None:
    """The same bytes from the same options, repeated ones and sizes among them; not a word said."""
    styles = ("--style", "flat", "--style", "edges:width=2")
    asked = (*QUICK_FLAGS, *styles, "--frames", "2-5", "--size", "48x32", "--no-audio")
    assert main(["animate", str(clip), "-o", str(tmp_path / "a.mp4"), *asked, "-q"]) == 0
    result = trimotion.animate(
        clip,
        tmp_path / "b.mp4",
        styles=["flat", "edges:width=2"],
        frames="2-5",
        size=(48, 32),
        audio=False,
        **QUICK,
    )
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()
    assert (result.output, result.frames) == (tmp_path / "b.mp4", 4)
    assert 0 < result.mean_rmse < 100
    assert result.seconds > 0
    captured = capfd.readouterr()
    assert (captured.out, captured.err) == ("", "")


def test_calls_log_to_who_listens(clip: Path, tmp_path: Path, caplog, capfd) -> None:
    """Frames, choices and damage by their levels; the summary comes last."""
    stills = tmp_path / "s_##.png"
    with caplog.at_level(logging.DEBUG, "trimotion"):
        result = trimotion.animate(clip, stills, frames="1-2", **QUICK)
    told = [(r.levelname, r.getMessage()) for r in caplog.records if r.name == "trimotion"]
    first = next(text for level, text in told if level == "DEBUG")
    assert first.startswith("frame 1 of 2, rmse ")
    assert [text for level, text in told if level == "INFO"] == [
        *(f"{clip}: {note}" for note in result.notes),
        told[-1][1],
    ]
    assert f"{clip}: 2 frames in " in told[-1][1]
    assert result.notes
    assert capfd.readouterr() == ("", "")


def test_solve_render_measure(clip: Path, tmp_path: Path) -> None:
    """A track, two pictures of it and the report of one, as from the command line."""
    track = tmp_path / "t.mtrk"
    solved = trimotion.solve(clip, track, frames="0-3", **QUICK)
    assert (solved.output, solved.frames, solved.warnings) == (track, 4, ())
    drawn = trimotion.render(track, tmp_path / "d_##.png", frames=2, scale=0.5)
    assert drawn.frames == 1
    assert (tmp_path / "d_02.png").is_file()
    trimotion.render(track, tmp_path / "d.mkv", source=clip, styles="edges")
    report = trimotion.measure(clip, tmp_path / "d.mkv", track=track)
    assert len(report.frames) == 4
    assert report.track is not None
    assert report.track.inverted == 0
    assert report.as_dict()["frames"] == 4


def test_notes_and_warnings_speak_of_keywords(clip: Path, tmp_path: Path) -> None:
    """What was chosen is in the result, without flags; it is equal to itself and frozen."""
    result = trimotion.animate(clip, tmp_path / "a.png", frames=0, focus="center", **QUICK)
    assert any("focus center" in note for note in result.notes)
    assert not any("--" in note for note in result.notes)
    with pytest.raises(AttributeError):
        result.frames = 3  # type: ignore[misc]


def test_errors_are_of_their_kind(clip: Path, tmp_path: Path) -> None:
    """An output that exists, a source that is none, a track of other options."""
    (tmp_path / "a.mp4").touch()
    with pytest.raises(trimotion.OutputError, match="overwrite=True") as caught:
        trimotion.animate(clip, tmp_path / "a.mp4")
    assert "overwrite=True" in caught.value.remedy
    with pytest.raises(trimotion.MediaError):
        trimotion.animate(tmp_path / "a.mp4", tmp_path / "b.mp4")
    trimotion.solve(clip, tmp_path / "t.mtrk", frames="0-1", **QUICK)
    with pytest.raises(trimotion.OptionError, match=r"resume=True: .*triangles=41 instead"):
        trimotion.solve(clip, tmp_path / "t.mtrk", **{**QUICK, "triangles": 41}, resume=True)


def test_progress_is_told_to_a_function(clip: Path, tmp_path: Path) -> None:
    """Every frame in order, with its figures; measuring tells no triangles."""
    told: list[trimotion.FrameDone] = []
    out = tmp_path / "a.mkv"
    trimotion.animate(clip, out, frames="0-2", progress=told.append, **QUICK)
    assert [done.done for done in told] == [1, 2, 3]
    assert {done.total for done in told} == {3}
    assert all(done.rmse > 0 and done.triangles for done in told)
    told.clear()
    trimotion.measure(clip, out, frames="0-2", progress=told.append)
    assert [(done.done, done.triangles) for done in told] == [(1, None), (2, None), (3, None)]


def test_progress_true_is_that_of_the_command(clip: Path, tmp_path: Path, capsys) -> None:
    """Lines on the error stream if that is no terminal."""
    trimotion.animate(clip, tmp_path / "a.png", frames=0, progress=True, **QUICK)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "frame 1/1" in captured.err
    assert "mean rmse" in captured.err


@pytest.mark.parametrize("error", [ValueError("enough"), KeyboardInterrupt()])
def test_what_progress_raises_ends_the_run(
    error: BaseException, clip: Path, tmp_path: Path
) -> None:
    """It comes out as it is; nothing is left but the track, which can be gone on with."""

    def stop(done: trimotion.FrameDone) -> None:
        """Raise at the third frame."""
        if done.done == 3:
            raise error

    before = {thread for thread in threading.enumerate() if thread.name != "trimotion-part"}
    track = tmp_path / "t.mtrk"
    with pytest.raises(type(error)):
        trimotion.animate(clip, tmp_path / "a.mp4", track=track, progress=stop, **QUICK)
    assert [path.name for path in tmp_path.iterdir()] == ["t.mtrk"]
    after = {thread for thread in threading.enumerate() if thread.name != "trimotion-part"}
    assert after <= before
    trimotion.animate(clip, tmp_path / "a.mp4", track=track, resume=True, **QUICK)
    with TrackReader(track) as reader:
        assert [row.frame for row in reader.rows] == list(range(COUNT))


@pytest.mark.skipif(not hasattr(Device, "close"), reason="devices do not end their threads yet")
def test_calls_leave_no_threads(clip: Path, tmp_path: Path) -> None:
    """However often something is called."""
    count = threading.active_count()
    for number in range(2):
        trimotion.animate(clip, tmp_path / f"{number}.png", frames=0, threads=4, **QUICK)
        trimotion.triangulate(np.zeros((20, 30), np.uint8), triangles=8, threads=4).draw()
    gc.collect()
    assert threading.active_count() <= count


def test_works_in_other_threads_under_a_loop(clip: Path, tmp_path: Path) -> None:
    """Two at once, beside a running loop, and one in the loop itself; signals stay as they are."""

    async def convert() -> list[trimotion.Result]:
        """Two conversions in threads, one in the loop."""
        names = [tmp_path / f"{number}.mtrk" for number in range(3)]
        both = asyncio.gather(
            *(asyncio.to_thread(trimotion.solve, clip, n, frames="0-3", **QUICK) for n in names[:2])
        )
        return [*await both, trimotion.solve(clip, names[2], frames="0-3", **QUICK)]

    results = asyncio.run(convert())
    rows = [rows_of(result.output)["meshes"] for result in results]
    assert rows[0] == rows[1] == rows[2]


def test_processes_give_the_same_track(clip: Path, tmp_path: Path) -> None:
    """`jobs=2` is only faster (here two processes start, which takes seconds)."""
    frames = f"{CUT - 2}-{CUT + 1}"
    trimotion.solve(clip, tmp_path / "a.mtrk", frames=frames, jobs=2, **QUICK)
    trimotion.solve(clip, tmp_path / "b.mtrk", frames=frames, **QUICK)
    assert rows_of(tmp_path / "a.mtrk") == rows_of(tmp_path / "b.mtrk")


def test_program_without_guard_is_told(clip: Path, tmp_path: Path) -> None:
    """New processes import a program (three start here); one that would start others says so."""
    program = tmp_path / "program.py"
    call = f"trimotion.solve({str(clip)!r}, {str(tmp_path / 'c.mtrk')!r}, jobs=2, triangles=40)"
    program.write_text(f"import trimotion\n{call}\n")
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])}
    failed = subprocess.run(
        [sys.executable, program], env=environment, cwd=tmp_path, capture_output=True, text=True
    )
    assert failed.returncode != 0
    assert "jobs=2: a new process imports your program and would run it" in failed.stderr
    last = failed.stderr.splitlines()[-1]
    assert last.startswith("warp_kernels.errors.OptionError: a process of jobs died")
    assert 'if __name__ == "__main__":' in last
