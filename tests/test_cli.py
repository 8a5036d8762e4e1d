"""The command line: every mistake is one line with its exit code; help is complete and light."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np
import pytest

from pipeline import cli
from pipeline.cli import main
from pipeline.options.command_line import job_options
from pipeline.track import TrackReader
from stages.flows import FLOWS
from stages.layouts import LAYOUTS
from stages.media import open_decoder
from tests import media_samples as samples
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.errors import MediaError, OptionError, OutputError, TrackError, TrimotionError
from warp_kernels.styles import STYLES

ROOT = Path(__file__).parents[1]

# Options of `animate` that cannot be met, and a word that the message has to hold.
USAGE_ERRORS = [
    ("--triangles 0", "--triangles 0"),
    ("--triangles -5", "-5"),
    ("--triangles many", "many"),
    ("--triangles 1.5", "1.5"),
    ("--error 0", "--error 0"),
    ("--error nan", "nan"),
    ("--error inf", "inf"),
    ("--color pink", "pink"),
    ("--iterations -1", "-1"),
    ("--frame-iterations -1", "-1"),
    ("--topology torus", "delaunay"),
    ("--sums guess", "fragments"),
    ("--space hsv", "oklab"),
    ("--regularity nan", "nan"),
    ("--regularity -1", "-1"),
    ("--trust-region 0", "--trust-region 0"),
    ("--trust-region x", "'x'"),
    ("--layout hexagons", "importance"),
    ("--layout grid:cells=3", "cells"),
    ("--layout importance:even_share=some", "some"),
    ("--flow magic", "dis"),
    ("--flow dis:speed=9", "preset"),
    ("--flow dis:preset=wild", "fast"),
    ("--flow dis:lines=3", "12 or more"),
    ("--flow dis:lines=3.5", "whole number"),
    ("--style sparkle", "flat"),
    ("--style edges:thickness=2", "width"),
    ("--style edges:width=thick", "thick"),
    ("--style edges:width=nan", "nan"),
    ("--style edges:width=-1", "-1"),
    ("--style edges:width", "KEY=VALUE"),
    ("--style edges:width=1,width=2", "twice"),
    ("--style edges:color=reddish", "reddish"),
    ("--style flat:colour=red", "opacity"),
    ("--style flat --style nothing", "nothing"),
    ("--size 0x10", "0x10"),
    ("--size 10x0", "10x0"),
    ("--size 640", "640"),
    ("--size -3x4", "argument"),
    ("--size 99999x99999", "99999"),
    ("--scale 0", "--scale 0"),
    ("--scale -2", "-2"),
    ("--scale nan", "nan"),
    ("--scale 1e308", "1e+308"),
    ("--size 10x10 --scale 2", "--size"),
    ("--frames 9-3", "9-3"),
    ("--frames 0:9", "A-B"),
    ("--frames some", "some"),
    ("--frames 0-9x0", "steps"),
    ("--start soon", "soon"),
    ("--start 5 --end 2", "swap"),
    ("--cuts nowhere.txt", "nowhere.txt"),
    ("--codec", "argument"),
    ("--crf best", "best"),
    ("--device gpu", "gpu"),
    ("--device cuda:x", "cuda:x"),
    ("--threads -1", "-1"),
    ("--threads 123456", "123456"),
    ("--seed -1", "-1"),
    ("--jobs 0", "--jobs 0"),
    ("--jobs some", "some"),
    ("--progress loud", "plain"),
    ("--preset nowhere", "preview"),
    ("--triangle 5", "--triangles"),
    ("--tri 5", "--triangles"),
    ("surplus.mp4", "surplus.mp4"),
]

# (what a command raises, exit code, part of the line)
FAILURES = [
    (TrimotionError("too odd; even it"), 1, "too odd; even it"),
    (OptionError("--x 3: no"), 2, "--x 3: no"),
    (MediaError("a.mp4", "is empty", "copy it again"), 3, "a.mp4: is empty; copy it again"),
    (TrackError("a track\nof two lines"), 3, "a track of two lines"),
    (OutputError("b.mp4", "disk full", "make room"), 4, "b.mp4: disk full; make room"),
    (ValueError("surprise"), 1, "internal error (ValueError: surprise); run again with --debug"),
    (MemoryError(), 1, "out of memory"),
    (KeyboardInterrupt(), 130, "interrupted"),
]


@pytest.fixture
def doubtful(tmp_path: Path) -> list[str]:
    """The command that converts a clip of two frames, with something to note and to warn of."""
    clip = samples.write_video(tmp_path / "in.mp4", [samples.picture(32, 24, n) for n in (0, 1)])
    black = [np.zeros((24, 32, 3), np.uint8)] * 2
    weights = samples.write_video(tmp_path / "w.mkv", black, codec="ffv1", pixel_format="gray")
    quick = ["--triangles", "20", "--iterations", "2", "--frame-iterations", "1"]
    command = ["animate", str(clip), "-o", str(tmp_path / "out.mp4"), *quick]
    return [*command, "--weights", str(weights)]


WARNING = "warning: {}: black in every frame; paint white what counts"
NOTE = "note: --focus picture:file={}"


def run_failing(error: BaseException, *more: str) -> int:
    """Run a command that raises."""

    def fail(arguments) -> None:
        raise error

    return main(["info", "x", *more], {"info": fail})


def assert_one_line(captured, *words: str) -> None:
    """The only output is one error line that holds the words."""
    assert captured.out == ""
    assert captured.err.startswith("trimotion: error: ")
    assert captured.err.count("\n") == 1
    assert captured.err.endswith("\n")
    for word in words:
        assert word in captured.err


@pytest.mark.parametrize(("options", "word"), USAGE_ERRORS, ids=[o for o, _ in USAGE_ERRORS])
def test_impossible_option_is_one_line(
    options: str, word: str, tmp_path: Path, monkeypatch, capsys
) -> None:
    """Exit code 2, what, the value or what is allowed, before it is seen that there is no input."""
    monkeypatch.chdir(tmp_path)
    assert main(["animate", "in.mp4", "-o", "out.mp4", *options.split()]) == 2
    assert_one_line(capsys.readouterr(), word)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "arguments",
    [
        "dance",
        "animate",
        "animate in.mp4",
        "animate -o out.mp4",
        "info",
        "measure a",
        "solve in.mp4",
        "solve in.mp4 -o a.mtrk --style flat",
        "render a.mtrk",
        "render a.mtrk -o a.mp4 --triangles 5",
        "plan",
        "plan in.mp4 --parts some",
        "join -o a.mtrk",
        "info a b",
    ],
)
def test_incomplete_command_is_one_line(arguments: str, capsys) -> None:
    """A missing or surplus argument names itself and points to the help."""
    assert main(arguments.split()) == 2
    assert_one_line(capsys.readouterr(), "--help")


@pytest.mark.parametrize("arguments", [["", "-o", "x.mp4"], ["x.mp4", "-o", ""]])
def test_empty_name_is_a_usage_error(arguments: list[str], capsys) -> None:
    """A variable of a script that was not set."""
    assert main(["animate", *arguments]) == 2
    assert_one_line(capsys.readouterr(), "empty")


@pytest.mark.parametrize(("error", "code", "line"), FAILURES, ids=[str(f[1]) for f in FAILURES])
def test_failure_becomes_line_and_exit_code(error, code: int, line: str, capsys):
    """Every failure of a command, expected or not."""
    assert run_failing(error) == code
    assert_one_line(capsys.readouterr(), line)


def test_debug_shows_the_traceback(capsys) -> None:
    """The traceback comes before the line, which stays."""
    assert run_failing(OptionError("--x 3: no"), "--debug") == 2
    lines = capsys.readouterr().err.splitlines()
    assert lines[0].startswith("Traceback")
    assert lines[-1] == "trimotion: error: --x 3: no"


def test_termination_cleans_up(capsys) -> None:
    """SIGTERM unwinds the command, so that open outputs are removed, and ends with 143."""
    cleaned = []

    def wait(arguments) -> None:
        try:
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(5)
        finally:
            cleaned.append(True)

    before = signal.getsignal(signal.SIGTERM)
    assert main(["info", "x"], {"info": wait}) == 143
    assert cleaned == [True]
    assert signal.getsignal(signal.SIGTERM) is before
    assert_one_line(capsys.readouterr(), "terminated")


@pytest.mark.parametrize(
    ("command", "hint"),
    [
        (["solve", "a.mp4", "-o", "a.mtrk"], "--resume"),
        (["animate", "a.mp4", "-o", "b.mp4", "--track", "a.mtrk"], "--resume"),
        (["animate", "a.mp4", "-o", "b.mp4"], "no unfinished file"),
        (["render", "a.mtrk", "-o", "b.mp4"], "no unfinished file"),
    ],
)
def test_interruption_tells_what_is_left(command, hint: str, capsys) -> None:
    """A track goes on; every other file is whole or not there."""

    def interrupt(arguments) -> None:
        raise KeyboardInterrupt

    assert main(command, {command[0]: interrupt}) == 130
    assert_one_line(capsys.readouterr(), "interrupted", hint)


def test_reader_that_leaves_is_no_error() -> None:
    """`trimotion ... | head -0` prints no traceback."""
    script = "import sys; from pipeline import cli\n"
    script += "sys.exit(cli.main(['info', 'x'], {'info': lambda a: print('x' * 100000)}))"
    read_end, write_end = os.pipe()
    os.close(read_end)
    command = [sys.executable, "-c", script]
    with os.fdopen(write_end, "wb") as closed:
        run = subprocess.run(command, cwd=ROOT, stdout=closed, stderr=subprocess.PIPE)
    assert run.returncode == 1
    assert b"Traceback" not in run.stderr


def test_help_and_mistakes_import_nothing_heavy() -> None:
    """Help must come at once: Warp, OpenCV, FFmpeg and NumPy together take more than a second."""
    script = "import sys; from pipeline.cli import main\n"
    script += "main(['animate', '--help']); main(['animate', '--typo']); main(['--help'])\n"
    script += "print('loaded', {'warp', 'cv2', 'av', 'numpy', 'scipy'} & sys.modules.keys())"
    command = [sys.executable, "-c", script]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert run.stdout.splitlines()[-1] == "loaded set()"


def test_help_lists_options_and_members(capsys) -> None:
    """Every option, and every member of every registry."""
    assert main(["animate", "--help"]) == 0
    text = capsys.readouterr().out
    for option in job_options():
        assert f"--{option.flag}" in text
    for flag, registry in (("layout", LAYOUTS), ("flow", FLOWS), ("style", STYLES)):
        for name in registry:
            assert f"--{flag} {name}" in text
    for name in COLOR_MODELS:
        assert name in text
    assert "(default: 1500)" in text


@pytest.mark.parametrize("command", [[], *([name] for name in cli.COMMANDS)])
def test_help_of_other_commands(command: list[str], capsys) -> None:
    """Help goes to standard output, exit code 0."""
    assert main([*command, "--help"]) == 0
    assert "usage: trimotion" in capsys.readouterr().out


def test_version(capsys) -> None:
    """One line with the program's name."""
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("trimotion ")


def test_animate_does_what_was_asked_for(doubtful: list[str], tmp_path: Path, capsys) -> None:
    """Options of all kinds arrive; the last lines tell what came of it."""
    track = tmp_path / "t.mtrk"
    options = ["--style", "flat", "--style", "paper:color=#f00,grain=0,sheets=0", "--seed", "3"]
    files = ["--track", str(track), "--size", "64x48", "--threads", "1", "--progress", "plain"]
    assert main([*doubtful, *options, *files]) == 0
    with TrackReader(track) as reader:
        assert reader.header.solve.triangulate.refine.triangles == 20
        assert reader.header.solve.seed == 3
    with open_decoder(tmp_path / "out.mp4") as decoder:
        red = next(decoder).pixels
    assert red.shape == (48, 64, 3)
    np.testing.assert_allclose(red.reshape(-1, 3).mean(axis=0), (255, 0, 0), atol=6)
    captured = capsys.readouterr()
    assert captured.out == ""
    told = r"2 frames in \d+\.\d s \(\d+\.\d fps\), mean rmse \d+\.\d\d: .*out\.mp4\n"
    assert re.search(told, captured.err)
    for line in (WARNING, NOTE):
        assert line.format(tmp_path / "w.mkv") in captured.err


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        (["-q"], [WARNING]),
        (["--progress", "none"], [WARNING]),
        (["--progress", "none", "-v"], [NOTE, WARNING]),
    ],
)
def test_quiet_and_verbose(options, expected, doubtful: list[str], tmp_path: Path, capsys) -> None:
    """Damage is always told, choices unless told to be quiet."""
    assert main([*doubtful, *options]) == 0
    lines = [line.format(tmp_path / "w.mkv") for line in expected]
    assert capsys.readouterr().err == "".join(f"trimotion: {line}\n" for line in lines)


def test_json_progress_is_on_standard_output(doubtful: list[str], capsys) -> None:
    """Programs read standard output; each line is one object."""
    assert main([*doubtful, "--progress", "json"]) == 0
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [event["event"] for event in events] == ["frame", "frame", "note", "warning", "done"]


@pytest.mark.parametrize(
    ("source", "output", "code", "word"),
    [
        ("missing.png", "out.png", 3, "missing.png"),
        ("text.mp4", "out.mp4", 3, "text.mp4"),
        ("good.png", "good.png", 4, "input"),
        ("good.png", "old.png", 4, "--overwrite"),
        ("good.png", "nowhere/out.png", 4, "nowhere"),
        ("good.png", "out.xyz", 2, ".xyz"),
        ("good.png", "out", 2, "out"),
    ],
)
def test_bad_files(
    source: str, output: str, code: int, word: str, tmp_path: Path, monkeypatch, capsys
) -> None:
    """Inputs and outputs that cannot be used: one line, nothing written."""
    monkeypatch.chdir(tmp_path)
    cv2.imwrite("good.png", np.zeros((8, 8, 3), np.uint8))
    Path("text.mp4").write_text("no media\n")
    Path("old.png").write_bytes(b"old")
    before = sorted(tmp_path.rglob("*"))
    assert main(["animate", source, "-o", output, "--progress", "none"]) == code
    assert_one_line(capsys.readouterr(), word)
    assert sorted(tmp_path.rglob("*")) == before
    assert Path("old.png").read_bytes() == b"old"
