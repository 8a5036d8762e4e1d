"""A lack of memory is told as such, whatever the library that met it says."""

import subprocess
import sys

import pytest
from test_encode import ROOT

from warp_kernels.device.memory import is_out_of_memory

SCRIPT = """
import resource
from warp_kernels.device.memory import is_limit_near, is_out_of_memory
from warp_kernels.device.memory import refuse_if_short, refuse_without_room
from warp_kernels.errors import ShortMemoryError
limit = 2**29
resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
assert not is_limit_near()
refuse_without_room()
refuse_if_short(ValueError("a damaged packet is passed over"))
held = []
try:
    while True:
        held.append(bytearray(2**22))
except MemoryError:
    pass
assert is_limit_near()
assert is_out_of_memory(RuntimeError("generic error in an external library"))
for refused in (refuse_without_room, lambda: refuse_if_short(ValueError("FFmpeg's"))):
    try:
        refused()
    except ShortMemoryError as error:
        assert "out of memory" in str(error) and "ulimit" in str(error)
    else:
        raise AssertionError("goes on")
"""


IMPORTS = """
import pipeline.progress
from pipeline.cli import main
from warp_kernels.errors import MediaError, OutputError
"""
BLAMED = """
del held[20:]  # what was reached once counts
def blamed(cause):
    error = MediaError("a.mp4", "not a readable media file", "convert the file")
    error.__cause__ = cause
    return error
for error in (
    blamed(ValueError("resource temporarily unavailable")),
    ImportError("failed to map segment from shared object"),
    blamed(FileNotFoundError(2, "no such file")),
    blamed(None),
    OutputError("a.mp4", "exists already", "choose another"),
):
    def fails(_):
        raise error
    print(main(["info", "a.mp4"], {"info": fails}))
"""


def test_errors_that_come_from_a_lack_of_memory() -> None:
    """By their kind, by the system's number, or by what caused them."""
    caused = ValueError("x")
    caused.__cause__ = MemoryError()
    for error in (MemoryError(), OSError(12, "Cannot allocate memory"), caused):
        assert is_out_of_memory(error)
    assert not is_out_of_memory(OSError(28, "No space left on device"))


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell")
def test_near_a_limit_it_is_the_reason() -> None:
    """Libraries fail in ways of their own there."""
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell")
def test_too_small_a_limit_is_refused_before_libraries_are_loaded() -> None:
    """SciPy's OpenBLAS looked for memory for ever, OpenCV's crashed."""
    limited = "import resource as r; r.setrlimit(r.RLIMIT_AS, (2**28, 2**28)); "
    run = f"{limited}from pipeline.cli import main; raise SystemExit(main())"
    command = [sys.executable, "-c", run]
    done = subprocess.run([*command, "listen", "a.wav"], capture_output=True, text=True, cwd=ROOT)
    (line,) = done.stderr.splitlines()
    assert done.returncode == 1
    assert "limited to 268 MB, at least 734 MB are needed" in line
    done = subprocess.run([*command, "help"], capture_output=True, text=True, cwd=ROOT)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell")
def test_no_file_is_blamed_near_a_limit() -> None:
    """For what a library said; what is wrong with a file itself is told as ever."""
    command = [sys.executable, "-c", IMPORTS + SCRIPT + BLAMED]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
    assert done.stdout.split() == ["1", "1", "3", "3", "4"], done.stderr
    lines = done.stderr.splitlines()
    told = ["out of memory" in line and "ulimit" in line for line in lines]
    assert told == [True, True, False, False, False], lines
    assert not any("--scale" in line or "segment" in line for line in lines)  # info draws nothing
    assert not any("convert the file" in line for line in lines[:2])
