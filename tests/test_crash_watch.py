"""A crash inside of a library ends as one line."""

import subprocess
import sys

import pytest
from test_encode import ROOT

CRASHES = {
    "abort": "import os; os.abort()",
    "segmentation fault": "import ctypes; ctypes.string_at(0)",
}
ENDINGS = {
    "end": "pass",
    "error": "raise SystemExit(3)",
    "kill": "import os, signal; os.kill(os.getpid(), signal.SIGKILL)",
}


def run(code: str) -> subprocess.CompletedProcess[str]:
    """Run a program that is watched."""
    start = "from pipeline.commands.crash_watch import watch_for_crashes as w; w(); "
    command = [sys.executable, "-c", start + code]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT)


@pytest.mark.parametrize("crash", CRASHES)
def test_a_crash_is_one_line(crash: str) -> None:
    """It says what, and what to do."""
    done = run(CRASHES[crash])
    assert done.returncode != 0
    (line,) = done.stderr.splitlines()
    assert line.startswith("trimotion: error: a library crashed (")
    assert crash in line or "aborted" in line
    assert "convert" in line


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell")
def test_a_crash_near_a_limit_is_told_as_memory() -> None:
    """Libraries that do not look whether they got memory crash where they got none."""
    limit = "import resource as r; r.setrlimit(r.RLIMIT_AS, ({0}, {0})); "
    (line,) = run(
        "import ctypes; " + limit.format(1 << 40) + CRASHES["segmentation fault"]
    ).stderr.splitlines()
    assert line.startswith("trimotion: error: a library crashed (segmentation fault)")
    held = "size = int(open('/proc/self/statm').read().split()[0]) * r.getpagesize(); "
    near = "import ctypes, resource as r; " + held + "r.setrlimit(r.RLIMIT_AS, (size, size)); "
    (line,) = run(near + CRASHES["segmentation fault"]).stderr.splitlines()
    assert "a library crashed" in line
    assert "memory" in line  # the reason, or what may be where the process ended too soon to tell
    assert "ulimit -v" in line


@pytest.mark.parametrize("ending", ENDINGS)
def test_other_ends_are_silent(ending: str) -> None:
    """Whether it went well or not."""
    done = run(ENDINGS[ending])
    assert (done.stdout, done.stderr) == ("", "")


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell")
def test_an_end_without_a_word_is_told_where_memory_is_limited() -> None:
    """OpenBLAS gives up so; a run that ends by itself says nothing more."""
    limit = "import resource as r; r.setrlimit(r.RLIMIT_AS, (1 << 40, 1 << 40)); "
    (line,) = run(limit + "import ctypes; ctypes.CDLL(None).exit(1)").stderr.splitlines()
    assert line.startswith("trimotion: error: ended by a library or from outside")
    assert "memory is limited" in line
    assert "ulimit -v" in line
    command = f"{limit}import sys; from pipeline.cli import main; sys.exit(main())"
    done = subprocess.run(
        [sys.executable, "-c", command, "styles", "--nothing"],
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)


def test_the_command_line_is_watched() -> None:
    """And as quick as before to say a mistake."""
    done = subprocess.run(
        [sys.executable, "-m", "pipeline.cli", "animate"], capture_output=True, text=True, cwd=ROOT
    )
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)
