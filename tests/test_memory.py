"""A lack of memory is told as such, whatever the library that met it says."""

import subprocess
import sys

import pytest
from test_encode import ROOT

from warp_kernels.device.memory import is_out_of_memory

SCRIPT = """
import resource
from warp_kernels.device.memory import is_limit_near, is_out_of_memory
limit = 2**29
resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
assert not is_limit_near()
held = []
try:
    while True:
        held.append(bytearray(2**22))
except MemoryError:
    pass
assert is_limit_near()
assert is_out_of_memory(RuntimeError("generic error in an external library"))
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
