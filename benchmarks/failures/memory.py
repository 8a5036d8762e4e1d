"""A limit of memory that is set in the middle of runs: one line that says so, and nothing lost."""

import contextlib
import random
import resource
import shutil
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

from benchmarks.failures.films import content_of, done, ended, start
from benchmarks.failures.kills import COMMANDS, Command, copied, hidden_in, whole_runs

NAMES = ("solve", "animate --track", "render", "animate")
"""Which of the commands that are killed are limited."""
ROOMS = (0, 1 << 20, 8 << 20, 32 << 20)
"""How much more than at that moment they may take [bytes]."""
HIGH = 1 << 40
"""A limit that nothing reaches: most runs have one from their start on, as behind `ulimit -v`,
which falls at the moment; one in four has none before."""
TOLD = ("memory", "close other programs")
"""What the line holds: what was short, and what to do."""
CODES = (1, 3, 4)
"""Exit codes of who fails."""


def short_memory(given: Path, count: int, seed: int) -> Iterator[tuple[str, str]]:
    """Limit runs, go on with each, and compare.

    Args:
        given: A folder with `film.mp4` and `film.mtrk`.
        count: How many.
        seed: Chooses the moments.

    Yields:
        What was tried, and what is wrong; empty if nothing is.
    """
    chance = random.Random(seed)
    commands = [command for command in COMMANDS if command.name in NAMES]
    wanted, seconds = whole_runs(given, commands)
    for number in range(count):
        command = commands[number % len(commands)]
        room = ROOMS[number // len(commands) % len(ROOMS)]
        before = HIGH if chance.random() < 0.75 else None
        after = chance.uniform(0.05, 1.0) * seconds[command.name]
        folder = given.parent / f"limit{number}"
        copied(given, folder)
        problem = _limited(folder, command, (before, after, room), wanted[command.name])
        shutil.rmtree(folder)
        was = "no limit" if before is None else "a high limit"
        yield f"{command.name}: {was}, {room >> 20} MB more after {after:.1f} s", problem


def _limited(
    folder: Path, command: Command, limit: tuple[int | None, float, int], wanted: str
) -> str:
    """Limit one run and go on; gives what is wrong."""
    before, after, room = limit
    process = start(command.words, folder)
    if before is not None:
        resource.prlimit(process.pid, resource.RLIMIT_AS, (before, before))
    try:
        process.wait(after)
    except subprocess.TimeoutExpired:
        _limit(process.pid, room)
    code, said = ended(process)
    # libraries crash or give up, which is told, but then nobody cleans up
    crashed = code in (-signal.SIGSEGV, -signal.SIGABRT) or "ended by a library" in said
    if code != 0 and not ((code in CODES or crashed) and _is_told(said)):
        return f"exit code {code}: {said}"
    output = folder / command.output
    if code == 0:
        return "" if content_of(output) == wanted else "other bits"
    if hidden_in(folder) and not crashed:
        return f"left {hidden_in(folder)}"
    if output.exists() and output.suffix != ".mtrk":
        return "left an output that is not whole"
    if output.exists():
        content_of(output)
    code, said = done([*command.words, *command.again], folder)
    if code:
        return f"does not go on: {said}"
    return "" if content_of(output) == wanted else "other bits after it went on"


def _is_told(said: str) -> bool:
    """Whether one line of the program says what was short; libraries may have had their say."""
    lines = [line for line in said.splitlines() if line.startswith("trimotion: error: ")]
    return len(lines) == 1 and all(told in lines[0] for told in TOLD)


def _limit(number: int, room: int) -> None:
    """Let a process take little more memory than it has now."""
    with contextlib.suppress(ProcessLookupError, FileNotFoundError, StopIteration):
        lines = Path(f"/proc/{number}/status").read_text().splitlines()
        size = next(line for line in lines if line.startswith("VmSize:"))
        limit = int(size.split()[1]) * 1024 + room
        resource.prlimit(number, resource.RLIMIT_AS, (limit, limit))
