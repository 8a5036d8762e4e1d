"""What became of many attempts in one process: failures, the slowest, the memory."""

import contextlib
import io
import re
import resource
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from warp_kernels.errors import TrimotionError

PYTHON = re.compile(
    r"<class |<[\w.]+ object|\bnp\.|array\(|KeyError|TypeError|ValueError|Errno|Traceback"
    r"|internal error|NoneType|not subscriptable|has no attribute|unsupported operand"
)
"""What no message to a user holds."""
LONGEST = 1500
"""Letters of a line at most."""
SLOWEST = 20.0
"""What takes longer to compute hangs [s of the CPU]: machines are busy."""
STUCK = 300.0
"""As does what waits for so long [s]."""


class HangError(Exception):
    """Something took longer than it may."""


@dataclass
class Watch:
    """Counts what is tried.

    Args:
        name: What is tried, for the table.
    """

    name: str
    count: int = 0
    """How many there were."""
    refused: int = 0
    """How many of them were told to be wrong."""
    slowest: float = 0.0
    """The longest of all [s of the CPU]."""
    bad: list[str] = field(default_factory=list)
    """What was not as it must be."""

    def attempt(self, what: str, work: Callable[[], object]) -> None:
        """Read something; a `TrimotionError` with plain words is as good as success.

        Args:
            what: What it is, for the report.
            work: Reads it.
        """
        begun = time.process_time()
        try:
            with _at_most():
                work()
        except TrimotionError as error:
            self.refused += 1
            self._check(what, str(error))
        except Exception:
            self.bad.append(f"{what}: {traceback.format_exc()[-1500:]}")
        self._count(begun)

    def command(self, words: list[str], codes: tuple[int, ...] = (0, 2, 3, 4)) -> None:
        """Run a command in this process; it ends well, or with one plain line.

        Args:
            words: Its arguments.
            codes: Exit codes that it may have.
        """
        from pipeline.cli import main

        begun, said = time.process_time(), io.StringIO()
        code: int | str
        try:
            with (
                _at_most(),
                contextlib.redirect_stderr(said),
                contextlib.redirect_stdout(io.StringIO()),
            ):
                code = main(words)
        except Exception:
            code = traceback.format_exc()[-1500:]
        what, lines = " ".join(words), said.getvalue().splitlines()
        errors = [line for line in lines if line.startswith("trimotion: error: ")]
        if code not in codes:
            self.bad.append(f"{what}: {code}: {said.getvalue()[-500:]}")
        elif code != 0 and len(errors) != 1:
            self.bad.append(f"{what}: {len(errors)} lines: {said.getvalue()[-500:]}")
        for line in lines:
            self._check(what, line)
        self.refused += code != 0
        self._count(begun)

    def _check(self, what: str, line: str) -> None:
        if PYTHON.search(line):
            self.bad.append(f"{what}: words of Python: {line[:300]}")
        if len(line) > LONGEST:
            self.bad.append(f"{what}: a line of {len(line)} letters: {line[:100]}")

    def _count(self, begun: float) -> None:
        self.count += 1
        self.slowest = max(self.slowest, time.process_time() - begun)

    def __str__(self) -> str:
        return (
            f"| {self.name} | {self.count} | {self.refused} refused | {len(self.bad)} bad "
            f"| slowest {self.slowest:.1f} s | peak {peak()} MB |"
        )


def peak() -> int:
    """Most memory that this process had so far [MB]."""
    used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return used // (1024 if sys.platform != "darwin" else 1 << 20)


@contextmanager
def _at_most() -> Iterator[None]:
    def late(*_: object) -> None:
        raise HangError(f"takes longer than {SLOWEST:.0f} s")

    timers = {signal.SIGPROF: (signal.ITIMER_PROF, SLOWEST)}
    timers[signal.SIGALRM] = (signal.ITIMER_REAL, STUCK)
    before = {sign: signal.signal(sign, late) for sign in timers}
    for timer, seconds in timers.values():
        signal.setitimer(timer, seconds)
    try:
        yield
    finally:
        for sign, (timer, _) in timers.items():
            signal.setitimer(timer, 0)
            signal.signal(sign, before[sign])
