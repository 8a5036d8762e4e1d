"""Runs that are killed at random moments: resumed to the same bits, or a clean start."""

import random
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.failures.films import (
    QUICK,
    QUIET,
    content_of,
    done,
    ended,
    is_one_line,
    start,
)

SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
CODES = {signal.SIGKILL: -9, signal.SIGTERM: 143, signal.SIGINT: 130}
"""Exit codes of runs that were ended by a signal."""


@dataclass(frozen=True)
class Command:
    """A command that is killed."""

    name: str
    """What it is called in the table."""
    words: tuple[str, ...]
    """Its arguments; FOLDER is where it works."""
    output: str
    """What it makes."""
    again: tuple[str, ...]
    """What is added to its arguments to go on."""


OPTIONS = (*QUICK, *QUIET)
COMMANDS = (
    Command("solve", ("solve", "film.mp4", "-o", "a.mtrk", *OPTIONS), "a.mtrk", ("--resume",)),
    Command(
        "solve --jobs 2",
        ("solve", "film.mp4", "-o", "a.mtrk", "--jobs", "2", *OPTIONS),
        "a.mtrk",
        ("--resume",),
    ),
    Command(
        "animate --track",
        ("animate", "film.mp4", "-o", "a.mkv", "--codec", "ffv1", "--track", "a.mtrk", *OPTIONS),
        "a.mkv",
        ("--resume",),
    ),
    Command(
        "animate",
        ("animate", "film.mp4", "-o", "a.mkv", "--codec", "ffv1", *OPTIONS),
        "a.mkv",
        ("--overwrite",),
    ),
    Command(
        "render",
        ("render", "film.mtrk", "-o", "a.mkv", "--codec", "ffv1", "--scale", "2", *QUIET),
        "a.mkv",
        ("--overwrite",),
    ),
    Command(
        "join",
        ("join", "part0.mtrk", "part1.mtrk", "-o", "a.mtrk"),
        "a.mtrk",
        ("--overwrite",),
    ),
)


def kills(given: Path, count: int, seed: int) -> Iterator[tuple[str, str]]:
    """Kill runs, go on with each, and compare.

    Args:
        given: A folder with `film.mp4`, `film.mtrk`, `part0.mtrk` and `part1.mtrk`.
        count: How many.
        seed: Chooses the moments.

    Yields:
        What was tried, and what is wrong; empty if nothing is.
    """
    chance = random.Random(seed)
    wanted, seconds = whole_runs(given, COMMANDS)
    for number in range(count):
        command = COMMANDS[number % len(COMMANDS)]
        sign = SIGNALS[(number // 2) % len(SIGNALS)]
        after = chance.uniform(0.25, 1.0) * seconds[command.name]
        folder = given.parent / f"kill{number}"
        copied(given, folder)
        problem = _killed(folder, command, sign, after, wanted[command.name])
        shutil.rmtree(folder)
        yield f"{command.name}: {sign.name} after {after:.1f} s", problem


def _killed(folder: Path, command: Command, sign: signal.Signals, after: float, wanted: str) -> str:
    """Kill one run and go on; gives what is wrong."""
    process = start(command.words, folder)
    try:
        process.wait(after)
    except subprocess.TimeoutExpired:
        process.send_signal(sign)
    code, said = ended(process)
    output = folder / command.output
    was_killed = code in (CODES[sign], -sign)
    if not was_killed and code != 0:
        return f"exit code {code}: {said}"
    if was_killed and sign != signal.SIGKILL and code > 0 and not is_one_line(said):
        return f"is told badly: {said}"
    if output.exists():
        try:
            found = content_of(output)
        except Exception as error:
            return f"broken output: {error}"
        if output.suffix != ".mtrk" and found != wanted:
            return "another output than that of a whole run"
    if was_killed and sign != signal.SIGKILL and hidden_in(folder):
        return f"left {hidden_in(folder)}"
    if not was_killed and output.exists():
        return "" if content_of(output) == wanted else "other bits"
    code, said = done([*command.words, *command.again], folder)
    if code:
        return f"does not go on: {said}"
    if content_of(output) != wanted:
        return "other bits after it went on"
    return f"left {hidden_in(folder)}" if hidden_in(folder) else ""


def whole_runs(given: Path, commands: Sequence[Command]) -> tuple[dict[str, str], dict[str, float]]:
    """Run commands to their ends.

    Args:
        given: As for `kills`.
        commands: Which.

    Returns:
        By their names, what they make, and how long they take [s].
    """
    wanted, seconds = {}, {}
    for command in commands:
        folder = given.parent / "whole"
        copied(given, folder)
        begun = time.monotonic()
        code, said = done(command.words, folder)
        assert code == 0, said
        seconds[command.name] = time.monotonic() - begun
        wanted[command.name] = content_of(folder / command.output)
        shutil.rmtree(folder)
    return wanted, seconds


def copied(given: Path, folder: Path) -> None:
    """Copy what is given to a new folder.

    Args:
        given: Where it is.
        folder: Where it goes; what is there is removed.
    """
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(given, folder)


def hidden_in(folder: Path) -> list[str]:
    """What lies there under names that no user gave.

    Args:
        folder: Where.
    """
    return sorted(path.name for path in folder.iterdir() if path.name.startswith(".trimotion"))
