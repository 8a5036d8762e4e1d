"""A small film of several shots, and what is compared of what was made of it."""

import hashlib
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import av
import numpy as np

from tests.media_samples import picture, write_video
from tests.tracks import rows_of

ROOT = Path(__file__).parents[2]
SHOTS, LENGTH = 3, 12
"""Shots of the film, and frames of each."""
QUICK = ("--triangles", "60", "--iterations", "16", "--frame-iterations", "8", "--focus", "none")
"""Options with which a run takes seconds."""
QUIET = ("--progress", "none")
TIMEOUT = 300.0
"""Longer than any run takes, compiling included [s]: whoever is not done by then hangs."""
HANGS = 999
"""In place of the exit code of those."""


def write_film(path: Path) -> Path:
    """Write a film of some shots, each of other colours, with sound.

    Args:
        path: Its name.
    """
    shots = [[picture(160, 120, number) for number in range(LENGTH)] for _ in range(SHOTS)]
    shots[1] = [255 - pixels[::-1] for pixels in shots[1]]
    shots[2] = [np.ascontiguousarray(pixels[:, ::-1, ::-1]) // 2 for pixels in shots[2]]
    return write_video(path, [pixels for shot in shots for pixels in shot], sound=1)


def start(
    words: Sequence[object], folder: Path, env: Mapping[str, str | None] | None = None
) -> "subprocess.Popen[str]":
    """Begin a command of the program.

    Args:
        words: Its arguments.
        folder: Where it works.
        env: Variables of the environment beside those that are there; None takes one away.
    """
    given = {**os.environ, "PYTHONPATH": str(ROOT), **(env or {})}
    return subprocess.Popen(
        [sys.executable, "-m", "pipeline.cli", *map(str, words)],
        cwd=folder,
        env={name: value for name, value in given.items() if value is not None},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
    )


def done(
    words: Sequence[object], folder: Path, env: Mapping[str, str | None] | None = None
) -> tuple[int, str]:
    """Run a command of the program to its end.

    Args:
        words: Its arguments.
        folder: Where it works.
        env: As for `start`.

    Returns:
        Exit code and what it said.
    """
    return ended(start(words, folder, env))


def ended(process: "subprocess.Popen[str]") -> tuple[int, str]:
    """Wait for a command; one that hangs is ended.

    Args:
        process: The command.

    Returns:
        Exit code, `HANGS` if it hung, and what it said.
    """
    try:
        _, said = process.communicate(timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return HANGS, "hangs"
    return process.returncode, said


def content_of(path: Path) -> str:
    """What is in an output: rows of a track, decoded pictures of a film, as a short sum.

    Args:
        path: The output.

    Raises:
        Exception: Whatever a broken file causes.
    """
    digest = hashlib.sha256()
    if path.suffix == ".mtrk":
        digest.update(repr(rows_of(path)).encode())
    else:
        with av.open(str(path)) as container:
            for frame in container.decode(video=0):
                digest.update(repr(frame.pts).encode())
                digest.update(frame.to_ndarray(format="rgb24").tobytes())
    return digest.hexdigest()


def is_one_line(said: str) -> bool:
    """Whether a failure was told as it must be.

    Args:
        said: What was printed on standard error.
    """
    lines = [line for line in said.splitlines() if "warning: " not in line]
    return len(lines) == 1 and lines[0].startswith("trimotion: error: ")
