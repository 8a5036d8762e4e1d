"""How far a run is: a bar, plain lines, JSON lines or nothing; `PROGRESS` names them.

Everything for people goes to standard error, JSON lines go to standard output.
"""

import contextlib
import json
import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

from pipeline.printable import printable

PLAIN_INTERVAL = 2.0
"""Time between the first plain lines [s]."""
PLAIN_SHARE = 0.05
"""Part of the time gone by between later ones: an hour has a hundred lines, not two thousand."""
LONGEST_INTERVAL = 60.0
"""Most time between two plain lines [s]: whoever watches a log must see that something moves."""
LEAST_COLUMNS = 40
"""A bar with its figures needs so many; a terminal that tells no size has 0."""
ONCE = "first run: kernels are compiled, once on this machine"
"""What a first run says before anything else."""


@dataclass(frozen=True)
class Summary:
    """What a finished run has to say."""

    frames: int
    """Frames that were written."""
    seconds: float
    """How long it took [s]."""
    mean_rmse: float
    """Mean over the frames of their rmse [code values]."""
    output: Path
    """Where the result lies."""

    @property
    def fps(self) -> float:
        """Frames per second."""
        return self.frames / self.seconds if self.seconds > 0 else 0.0

    def __str__(self) -> str:
        noun = "frame" if self.frames == 1 else "frames"
        return (
            f"{self.frames} {noun} in {self.seconds:.1f} s ({self.fps:.1f} fps), "
            f"mean rmse {self.mean_rmse:.2f}: {self.output}"
        )


class Progress:
    """Tells nothing but notes and warnings; the other members tell more.

    A context manager: leaving the block takes a bar off the screen.

    Args:
        verbose: Whether notes are told.
    """

    def __init__(self, *, verbose: bool = False) -> None:
        self._verbose = verbose
        self._start = time.perf_counter()
        self._warned: set[str] = set()

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Tell that a frame is finished.

        Args:
            done: Number of frames finished so far.
            total: Number of frames in all, None if unknown; may turn out to be wrong.
            triangles: Triangles of this frame.
            rmse: Its error [code values].
        """

    def compared(self, done: int, total: int | None, rmse: float) -> None:
        """Tell that a frame is compared with its source.

        Args:
            done: Number of frames compared so far.
            total: Number of frames in all, None if unknown; may turn out to be wrong.
            rmse: Its error [code values].
        """

    def moment(self, done: int, total: int, frame: int) -> None:
        """Tell that a moment of a preview is finished.

        Args:
            done: Number of moments finished so far.
            total: Number of moments in all.
            frame: Number of its frame.
        """

    def kernels(self, done: int, total: int | None) -> None:
        """Tell how many kernels are compiled, which happens once on a machine.

        Args:
            done: Number of kernels compiled so far.
            total: Number of those that were missing, None if unknown yet.
        """

    def note(self, text: str) -> None:
        """Tell a choice that was made, if the user wants to know."""
        if self._verbose:
            self._print(f"trimotion: note: {text}")

    def warn(self, text: str) -> None:
        """Tell something that the user has to know, once: a result repeats what was told before."""
        if text not in self._warned:
            self._warned.add(text)
            self._warn(text)

    def _warn(self, text: str) -> None:
        self._print(f"trimotion: warning: {text}")

    def finish(self, summary: Summary) -> None:
        """Tell that everything is done.

        Args:
            summary: What to say.
        """

    def file(self, number: int, total: int, source: str, output: str) -> None:
        """Tell that one of several inputs is begun.

        Args:
            number: Which one, from 1.
            total: How many there are.
            source: Its name.
            output: What becomes of it.
        """

    def finish_all(self, line: str, frames: int, failed: list[str], code: int) -> None:
        """Tell what came of several inputs.

        Args:
            line: All of it, for people.
            frames: Frames of those that were done.
            failed: Names of those that were not.
            code: The exit code.
        """

    def close(self) -> None:
        """Leave the screen tidy, whether all went well or not."""

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _fps(self, done: int) -> float:
        return done / max(time.perf_counter() - self._start, 1e-9)

    def _print(self, line: str) -> None:
        tell(line, sys.stderr)


def tell(line: str, stream: TextIO) -> None:
    """Print a line; nobody need be there any more to read it, and the work goes on.

    Args:
        line: The line.
        stream: Standard output or standard error.
    """
    try:
        print(printable(line), file=stream, flush=True)
    except OSError:
        hush(stream)


def hush(stream: TextIO) -> None:
    """Let what is still to be written to a stream disappear: its reader has left.

    Args:
        stream: Standard output or standard error.
    """
    with contextlib.suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)


class PlainProgress(Progress):
    """A line every now and then, for log files."""

    def __init__(self, *, verbose: bool = False) -> None:
        super().__init__(verbose=verbose)
        self._told = -PLAIN_INTERVAL

    def kernels(self, done: int, total: int | None) -> None:
        """Tell that it begins, how far it is if the last line is old enough, and that it ends."""
        if total is None:
            self._print(ONCE)
        elif done in (0, total) or self._is_due():
            self._told = time.perf_counter()
            self._print(f"compiling kernels {done}/{total}")

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Tell about a frame if the last line is old enough, or if it is the last frame."""
        self._tell(done, total, f"{triangles} triangles  rmse {rmse:.2f}")

    def compared(self, done: int, total: int | None, rmse: float) -> None:
        """Tell about a frame as often as about others."""
        self._tell(done, total, f"rmse {rmse:.2f}")

    def moment(self, done: int, total: int, frame: int) -> None:
        """Tell about a moment."""
        self._print(f"moment {done}/{total}  frame {frame}")

    def _tell(self, done: int, total: int | None, figures: str) -> None:
        if done != total and done > 1 and not self._is_due():
            return
        self._told = time.perf_counter()
        goal = "" if total is None else f"/{total}"
        self._print(f"frame {done}{goal}  {self._fps(done):.1f} fps  {figures}")

    def _is_due(self) -> bool:
        """Whether the last line is old enough."""
        now = time.perf_counter()
        wait = min(max(PLAIN_INTERVAL, PLAIN_SHARE * (now - self._start)), LONGEST_INTERVAL)
        return now - self._told >= wait

    def finish(self, summary: Summary) -> None:
        """Tell the summary."""
        self._print(str(summary))

    def file(self, number: int, total: int, source: str, output: str) -> None:
        """Tell its name."""
        self._print(f"{number}/{total} {source}")

    def finish_all(self, line: str, frames: int, failed: list[str], code: int) -> None:
        """Tell the summary of all."""
        self._print(line)


class BarProgress(Progress):
    """A bar on a terminal."""

    def __init__(self, *, verbose: bool = False) -> None:
        super().__init__(verbose=verbose)
        self._bar: Any = None

    def kernels(self, done: int, total: int | None) -> None:
        """Move a bar of its own, which goes when all are compiled."""
        if total is None:
            self._print(ONCE)
            return
        self._move(done, total, "compiled once", " kernels")
        if done == total:
            self.close()

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Move the bar."""
        self._move(done, total, f"{triangles} triangles, rmse {rmse:.2f}")

    def compared(self, done: int, total: int | None, rmse: float) -> None:
        """Move the bar."""
        self._move(done, total, f"rmse {rmse:.2f}")

    def moment(self, done: int, total: int, frame: int) -> None:
        """Tell about a moment: there are few."""
        self._print(f"moment {done}/{total}  frame {frame}")

    def _move(self, done: int, total: int | None, figures: str, unit: str = " frames") -> None:
        try:
            self._draw(done, total, figures, unit)
        except OSError:
            hush(sys.stderr)  # the terminal is gone

    def _draw(self, done: int, total: int | None, figures: str, unit: str) -> None:
        if self._bar is not None and self._bar.unit != unit:
            self.close()
        if self._bar is None:
            from tqdm import tqdm  # only a terminal needs it

            self._bar = tqdm(total=total, unit=unit, file=sys.stderr, dynamic_ncols=True)
        if self._bar.total is not None and done > self._bar.total:
            self._bar.total = None  # the file declared fewer frames than it has
        self._bar.set_postfix_str(figures, refresh=False)
        self._bar.update(done - self._bar.n)

    def finish(self, summary: Summary) -> None:
        """Tell the summary below the bar."""
        self.close()
        self._print(str(summary))

    def file(self, number: int, total: int, source: str, output: str) -> None:
        """Tell its name."""
        self._print(f"{number}/{total} {source}")

    def finish_all(self, line: str, frames: int, failed: list[str], code: int) -> None:
        """Tell the summary of all."""
        self._print(line)

    def close(self) -> None:
        """Leave the bar as it stands and go on below it."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None

    def _print(self, line: str) -> None:
        if self._bar is None:
            super()._print(line)
        else:
            self._bar.write(printable(line), file=sys.stderr)


class JsonProgress(Progress):
    """One JSON object a line, told apart by `event`: kernels, frame, note, warning, done;
    with several inputs also file and, at last, all done."""

    def kernels(self, done: int, total: int | None) -> None:
        """Write how far compiling is; the total is null before anything is known."""
        self._write("kernels", done=done, total=total)

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Write a frame's figures."""
        fps = round(self._fps(done), 3)
        self._write("frame", done=done, total=total, fps=fps, triangles=triangles, rmse=rmse)

    def compared(self, done: int, total: int | None, rmse: float) -> None:
        """Write a frame's error."""
        self._write("frame", done=done, total=total, fps=round(self._fps(done), 3), rmse=rmse)

    def note(self, text: str) -> None:
        """Write a note; programs can tell what they want to know."""
        self._write("note", text=text)

    def _warn(self, text: str) -> None:
        """Write a warning, on standard error as well."""
        self._write("warning", text=text)
        super()._warn(text)

    def finish(self, summary: Summary) -> None:
        """Write the summary."""
        self._write(
            "done",
            frames=summary.frames,
            seconds=round(summary.seconds, 3),
            fps=round(summary.fps, 3),
            mean_rmse=summary.mean_rmse,
            output=str(summary.output),
        )

    def file(self, number: int, total: int, source: str, output: str) -> None:
        """Write its name and that of the output."""
        self._write("file", number=number, total=total, source=source, output=output)

    def finish_all(self, line: str, frames: int, failed: list[str], code: int) -> None:
        """Write what came of all."""
        self._write("all done", frames=frames, failed=failed, code=code)

    def _write(self, event: str, **values: object) -> None:
        tell(json.dumps({"event": event, **values}), sys.stdout)


PROGRESS: dict[str, type[Progress]] = {
    "bar": BarProgress,
    "plain": PlainProgress,
    "json": JsonProgress,
    "none": Progress,
}
"""By name; `auto` picks the bar on a terminal that has room for one, else plain lines."""

CHOICES = ("auto", "plain", "json", "none")
"""What the command line offers: a bar that is not on a terminal is noise."""


def open_progress(name: str, *, verbose: bool = False) -> Progress:
    """Make a member of `PROGRESS`.

    Args:
        name: Its name, or `auto`.
        verbose: Whether notes are told.
    """
    if name == "auto":
        name = "bar" if _has_room_for_a_bar() else "plain"
    return PROGRESS[name](verbose=verbose)


def _has_room_for_a_bar() -> bool:
    """Whether standard error is a terminal that can draw over a line, and is wide enough."""
    if not sys.stderr.isatty() or os.environ.get("TERM") == "dumb":
        return False
    try:
        columns = os.get_terminal_size(sys.stderr.fileno()).columns
    except (OSError, ValueError):  # no real file, as in tests
        return True
    return columns >= LEAST_COLUMNS
