"""Progress: which member is picked, what each prints and where."""

import io
import json
import os
import subprocess
import sys
from contextlib import redirect_stderr
from itertools import pairwise
from pathlib import Path

import media_samples as samples
import pytest
from test_encode import ROOT

from pipeline.progress import (
    PROGRESS,
    BarProgress,
    JsonProgress,
    PlainProgress,
    Progress,
    Summary,
    open_progress,
)
from stages.media import probe

SUMMARY = Summary(frames=3, seconds=1.5, mean_rmse=20.25, output=Path("out.mp4"))


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        """Say so."""
        return True


def run(name: str, *, total: int | None = 3, verbose: bool = False) -> None:
    """Three frames, a note, a warning and the end."""
    with open_progress(name, verbose=verbose) as progress:
        for done in (1, 2, 3):
            progress.frame(done, total, 700 + done, 20.0 + done)
        progress.note("taken as bt709")
        progress.warn("breaks off")
        progress.finish(SUMMARY)


def test_auto_is_a_bar_only_on_a_terminal() -> None:
    """A log file gets lines."""
    with redirect_stderr(Terminal()):
        assert type(open_progress("auto")) is BarProgress
    with redirect_stderr(io.StringIO()):
        assert type(open_progress("auto")) is PlainProgress


@pytest.mark.parametrize("name", PROGRESS)
@pytest.mark.parametrize("total", [3, None, 2, 90])
def test_every_member_survives_any_total(name: str, total: int | None, capsys) -> None:
    """The number of frames may be unknown or wrong; warnings are told in any case."""
    run(name, total=total)
    assert "warning: breaks off" in capsys.readouterr().err


def test_bar_shows_figures_and_leaves_the_summary() -> None:
    """Frames, triangles and rmse; the last line is the summary."""
    with redirect_stderr(Terminal()) as terminal:
        run("bar")
    text = terminal.getvalue()
    assert "3/3" in text
    assert "703 triangles, rmse 23.00" in text
    assert text.rstrip().splitlines()[-1] == str(SUMMARY)


def test_bar_is_closed_when_a_job_fails() -> None:
    """The error line starts on a line of its own."""
    with redirect_stderr(Terminal()) as terminal:
        progress = open_progress("bar")
        progress.frame(1, 9, 700, 20.0)
        with pytest.raises(ValueError, match="full"), progress:
            raise ValueError("disk full")
    assert terminal.getvalue().endswith("\n")


def test_plain_lines_are_few_but_tell_the_last(capsys) -> None:
    """The first frame, then one every few seconds, the last one and the summary."""
    with open_progress("plain") as progress:
        for done in range(1, 101):
            progress.frame(done, 100, 700, 20.0)
        progress.finish(SUMMARY)
    captured = capsys.readouterr()
    lines = captured.err.splitlines()
    assert captured.out == ""
    assert lines[0].startswith("frame 1/100 ")
    assert lines[-2].startswith("frame 100/100 ")
    assert "700 triangles  rmse 20.00" in lines[-2]
    assert lines[-1] == "3 frames in 1.5 s (2.0 fps), mean rmse 20.25: out.mp4"
    assert len(lines) <= 6


def test_json_lines_hold_every_frame(capsys) -> None:
    """One object a line on standard output, nothing for people among them."""
    run("json")
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    frames = [event for event in events if event["event"] == "frame"]
    assert [frame["done"] for frame in frames] == [1, 2, 3]
    assert [frame["triangles"] for frame in frames] == [701, 702, 703]
    assert frames[0]["total"] == 3
    assert frames[2]["rmse"] == 23.0
    assert events[-1]["event"] == "done"
    assert events[-1]["mean_rmse"] == 20.25
    assert events[-1]["output"] == "out.mp4"
    assert isinstance(open_progress("json"), JsonProgress)


def test_none_is_silent_about_progress(capsys) -> None:
    """No frames, no summary; notes only when asked for."""
    run("none")
    assert capsys.readouterr().err == "trimotion: warning: breaks off\n"
    run("none", verbose=True)
    assert "note: taken as bt709" in capsys.readouterr().err
    assert type(open_progress("none")) is Progress


def test_summary_of_nothing_divides_by_nothing() -> None:
    """A job of no time has no frame rate."""
    assert Summary(1, 0.0, 0.0, Path("a.png")).fps == 0.0
    assert str(Summary(1, 1.0, 0.0, Path("a.png"))).startswith("1 frame in")


def test_every_member_tells_of_kernels_as_it_tells_of_frames(capsys) -> None:
    """At once that there are some, then how far it is; nothing with `none`."""
    for name in ("plain", "json", "none"):
        progress = open_progress(name)
        progress.kernels(0, None)
        for done in range(4):
            progress.kernels(done, 3)
    told = capsys.readouterr()
    plain = told.err.splitlines()
    assert plain[0].startswith("first run: ")
    assert plain[1:] == ["compiling kernels 0/3", "compiling kernels 3/3"]
    events = [json.loads(line) for line in told.out.splitlines()]
    assert [(e["done"], e["total"]) for e in events] == [(0, None), (0, 3), (1, 3), (2, 3), (3, 3)]
    with redirect_stderr(Terminal()) as terminal:
        bar = open_progress("bar")
        bar.kernels(0, 3)
        bar.kernels(2, 3)
        bar.frame(1, 9, 700, 20.0)
        bar.close()
    assert "2/3" in terminal.getvalue()
    assert "1/9" in terminal.getvalue()


@pytest.mark.parametrize(
    ("columns", "kind", "expected"),
    [
        (80, "xterm", "bar"),
        (40, "xterm", "bar"),
        (0, "xterm", "plain"),
        (10, "xterm", "plain"),
        (80, "dumb", "plain"),
    ],
)
def test_a_bar_needs_room(columns: int, kind: str, expected: str) -> None:
    """A terminal of no known size, a very narrow one and one that cannot go back get lines."""
    pty, termios = pytest.importorskip("pty"), pytest.importorskip("termios")
    ours, theirs = pty.openpty()
    termios.tcsetwinsize(theirs, (24 if columns else 0, columns))
    script = "from pipeline.progress import open_progress; print(type(open_progress('auto')))"
    with open(theirs, "wb", buffering=0) as terminal:
        done = subprocess.run(
            [sys.executable, "-c", script],
            stdout=subprocess.PIPE,
            stderr=terminal,
            text=True,
            cwd=ROOT,
            env={**os.environ, "TERM": kind},
        )
    os.close(ours)
    assert PROGRESS[expected].__name__ in done.stdout


def test_plain_lines_of_a_long_job_are_bounded(monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    """An hour is told in some hundred lines, and no minute goes by without one."""
    now = [1000.0]
    # real need: nobody waits for an hour
    monkeypatch.setattr("time.perf_counter", lambda: now[0])
    progress, told = open_progress("plain"), []
    for done in range(1, 36001):
        now[0] += 0.1
        progress.frame(done, 36000, 700, 20.0)
        if capsys.readouterr().err:
            told.append(now[0])
    assert len(told) < 150
    assert max(after - before for before, after in pairwise(told)) < 61


@pytest.mark.parametrize("how", ["json", "plain"])
def test_the_film_is_made_though_nobody_reads(tmp_path: Path, how: str) -> None:
    """The reader of the progress leaves at once, as `head -1` does: nothing is lost by it."""
    clip = samples.write_video(tmp_path / "in.mp4", [samples.picture(64, 48, n) for n in range(12)])
    target = tmp_path / "out.mp4"
    command = [sys.executable, "-m", "pipeline.cli", "animate", str(clip), "-o", str(target)]
    command += ["--triangles", "20", "--iterations", "2", "--progress", how]
    reading, writing = os.pipe()
    os.close(reading)
    with open(writing, "wb") as closed:
        done = subprocess.run(command, stdout=closed, stderr=closed, cwd=ROOT)
    assert done.returncode == 0
    assert probe(target).frame_count == 12
