"""Clusters of which something is killed: a worker, the scheduler, or the run that asked for it."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from benchmarks.failures.films import HANGS, ROOT, content_of, done, ended, is_one_line, start
from benchmarks.failures.kills import (
    CODES,
    OPTIONS,
    SIGNALS,
    Command,
    copied,
    hidden_in,
    whole_runs,
)

VICTIMS = ("a worker", "the run", "the scheduler")
"""Who is killed, in turn."""
WORKERS = 3
"""Of a cluster, with one thread each."""
FILE = "scheduler.json"
COMMANDS = (
    Command("solve", ("solve", "film.mp4", "-o", "a.mtrk", *OPTIONS), "a.mtrk", ("--resume",)),
    Command(
        "animate",
        ("animate", "film.mp4", "-o", "a.mkv", "--codec", "ffv1", "--track", "a.mtrk", *OPTIONS),
        "a.mkv",
        ("--resume",),
    ),
)
"""What is asked for, in turn."""


class Cluster:
    """A scheduler and its workers on this machine; a context manager that ends them.

    Args:
        folder: Where they may write, the file that names the scheduler among it.
    """

    def __init__(self, folder: Path) -> None:
        folder.mkdir(exist_ok=True)
        self._folder = folder
        self._scheduler: subprocess.Popen[bytes] | None = None
        self._workers: list[subprocess.Popen[bytes]] = []

    @property
    def address(self) -> str:
        """The scheduler's file."""
        return str(self._folder / FILE)

    def mend(self) -> None:
        """Start whoever is not there."""
        more = ("--scheduler-file", self.address)
        if self._scheduler is None or self._scheduler.poll() is not None:
            self.close()
            (self._folder / FILE).unlink(missing_ok=True)
            self._scheduler = self._started("scheduler", "--port", "0", "--no-dashboard", *more)
            while not (self._folder / FILE).exists():
                time.sleep(0.1)
        self._workers = [worker for worker in self._workers if worker.poll() is None]
        while len(self._workers) < WORKERS:
            options = ("--no-dashboard", "--nthreads", "1", "--no-nanny")
            self._workers.append(self._started("worker", *options, *more))

    def kill(self, victim: str, chance: random.Random) -> None:
        """Kill a worker, or the scheduler.

        Args:
            victim: One of `VICTIMS`.
            chance: Chooses the worker.
        """
        killed = chance.choice(self._workers) if victim == VICTIMS[0] else self._scheduler
        assert killed is not None
        killed.kill()
        killed.wait()

    def close(self) -> None:
        """End all of them."""
        for process in (*self._workers, self._scheduler):
            if process is not None:
                process.kill()
                process.wait()
        self._workers, self._scheduler = [], None

    def __enter__(self) -> "Cluster":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _started(self, *words: str) -> "subprocess.Popen[bytes]":
        return subprocess.Popen(
            [sys.executable, "-m", "dask", *words],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            cwd=self._folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )


def cluster_kills(given: Path, count: int, seed: int) -> Iterator[tuple[str, str]]:
    """Kill, go on with each, and compare.

    Args:
        given: A folder with `film.mp4`.
        count: How many.
        seed: Chooses the moments.

    Yields:
        What was tried, and what is wrong; empty if nothing is.
    """
    chance = random.Random(seed)
    wanted, _ = whole_runs(given, COMMANDS)
    folder = given.parent / "farmed"
    with Cluster(given.parent / "cluster") as cluster:
        seconds = _time_of(cluster, given, folder)
        for number in range(count):
            command, victim = COMMANDS[number % 2], VICTIMS[number // 2 % len(VICTIMS)]
            after = chance.uniform(0.1, 1.0) * seconds
            copied(given, folder)
            cluster.mend()
            process = start((*command.words, "--cluster", cluster.address), folder)
            try:
                process.wait(after)
            except subprocess.TimeoutExpired:
                sign = SIGNALS[number % len(SIGNALS)]
                if victim == VICTIMS[1]:
                    process.send_signal(sign)
                else:
                    sign = signal.SIGKILL
                    cluster.kill(victim, chance)
                victim = f"{victim} by {sign.name}"
            code, said = ended(process)
            problem = _left(folder, command, victim, code, said)
            yield (
                f"{command.name}: {victim} after {after:.1f} s",
                problem or _gone_on(folder, command, cluster, code, wanted[command.name]),
            )
            shutil.rmtree(folder)


def _time_of(cluster: Cluster, given: Path, folder: Path) -> float:
    """How long a run takes whose workers have imported what they need [s]."""
    for _ in range(2):
        cluster.mend()
        copied(given, folder)
        begun = time.monotonic()
        code, said = done((*COMMANDS[0].words, "--cluster", cluster.address), folder)
        assert code == 0, said
        seconds = time.monotonic() - begun
    return seconds


def _left(folder: Path, command: Command, victim: str, code: int, said: str) -> str:
    """What is wrong with how a run ended."""
    if code == HANGS:
        return said
    if victim.startswith(VICTIMS[0]):
        return f"exit code {code}: {said}" if code else ""
    if victim.startswith(VICTIMS[1]):
        if code not in (0, *CODES.values()):
            return f"exit code {code}: {said}"
    elif code not in (0, 1):
        return f"exit code {code}: {said}"
    if code > 0 and (not is_one_line(said) or "internal error" in said):
        return f"is told badly: {said}"
    output = folder / command.output
    if code and output.exists() and output.suffix != ".mtrk":
        return "left an output that is not whole"
    return ""


def _gone_on(folder: Path, command: Command, cluster: Cluster, code: int, wanted: str) -> str:
    """Go on where a run was ended; gives what is wrong."""
    output = folder / command.output
    if code:
        cluster.mend()
        words = (*command.words, *command.again, "--cluster", cluster.address)
        code, said = done(words, folder)
        if code:
            return f"does not go on: {said}"
    if content_of(output) != wanted:
        return "other bits"
    return f"left {hidden_in(folder)}" if hidden_in(folder) else ""
