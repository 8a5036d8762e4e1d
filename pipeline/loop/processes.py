"""`--jobs N`: ranges solved by N processes beside each other."""

import multiprocessing
import os
import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from multiprocessing.process import BaseProcess
from queue import Empty
from typing import Any

from pipeline.loop.ranges import InThisProcess, Part, Together, Work
from pipeline.loop.result import Animated
from pipeline.progress import Progress
from stages.media.writing.alone import alone
from warp_kernels.device.kernel_cache import settle_cache
from warp_kernels.device.memory import is_out_of_memory
from warp_kernels.errors import TrimotionError

PATIENCE = 0.5
"""How often the processes are looked after [s]."""
ORPHANS = 60.0
"""How long to wait for what a killed run left: its processes end after the frame that they are at
[s]."""


class PartError(TrimotionError):
    """A failure of one of the processes.

    Args:
        text: Its message.
        exit_code: Its exit code.
    """

    def __init__(self, text: str, exit_code: int) -> None:
        super().__init__(text)
        self.exit_code = exit_code


class LostPartError(PartError):
    """A process that ended without a word."""


class InProcesses:
    """Solves ranges in processes of their own, the longest first.

    Args:
        count: Most processes; each works with its share of the threads.
    """

    def __init__(self, count: int) -> None:
        self.places = count

    def run(self, work: Work, parts: Sequence[Part], progress: Progress) -> Sequence[Animated]:
        """Solve ranges beside each other.

        Args:
            work: How.
            parts: The ranges and their tracks.
            progress: Told of every finished frame.

        Raises:
            PartError: If a process fails or dies.
        """
        if len(parts) == 1:  # which has more threads here
            return InThisProcess().run(work, parts, progress)
        settle_cache()  # once for all processes
        count = min(self.places, len(parts))
        threads = work.run.threads or max(1, (os.cpu_count() or 1) // count)
        crew = _Crew(replace(work, run=replace(work.run, threads=threads, jobs=1)), parts, count)
        with crew.at_work():
            found = crew.results(Together(progress, parts))
        return [found[number] for number in range(len(parts))]


class _Crew:
    """Processes that take ranges from a queue and report on another."""

    def __init__(self, work: Work, parts: Sequence[Part], count: int) -> None:
        context = multiprocessing.get_context("spawn")
        self._count = len(parts)
        self._tasks: Any = context.Queue()
        self._reports: Any = context.Queue()
        spans = [(part.frames.last or 0) - part.frames.first for part in parts]
        for number in sorted(range(len(parts)), key=lambda number: -spans[number]):
            self._tasks.put((number, parts[number]))
        self._processes: list[BaseProcess] = [
            context.Process(
                target=_work, args=(work, self._tasks, self._reports, os.getpid()), daemon=True
            )
            for _ in range(count)
        ]

    @contextmanager
    def at_work(self) -> Iterator[None]:
        """Start the processes, and end them however the block ends."""
        try:
            for process in self._processes:
                process.start()
            yield
        finally:
            for process in self._processes:
                if process.pid is not None:
                    process.terminate()
                    process.join()

    def results(self, progress: Progress) -> dict[int, Animated]:
        """Hear reports until every range is finished; what each came to, by its number.

        Raises:
            PartError: If a process fails or dies.
        """
        found: dict[int, Animated] = {}
        while len(found) < self._count:
            try:
                kind, *values = self._reports.get(timeout=PATIENCE)
            except Empty:
                self._look_after()
                continue
            if kind == "frame":
                progress.frame(*values)
            elif kind == "kernels":
                progress.kernels(*values)
            elif kind == "error":
                raise PartError(*values)
            else:
                number, result = values
                found[number] = result
        return found

    def _look_after(self) -> None:
        for process in self._processes:
            if process.exitcode is not None and self._reports.empty():
                raise LostPartError(
                    f"a process of --jobs died (code {process.exitcode}); go on with --resume, "
                    "and fewer --jobs if memory was short",
                    1,
                )


class _Reporter(Progress):
    """Tells the first process of frames; ends when that one is gone."""

    def __init__(self, reports: Any, parent: int) -> None:
        super().__init__()
        self._reports = reports
        self._parent = parent

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Tell that a frame is finished."""
        _watch(self._parent)
        self._reports.put(("frame", done, total, triangles, rmse))

    def kernels(self, done: int, total: int | None) -> None:
        """Tell how far compiling is."""
        self._reports.put(("kernels", done, total))


def _watch(parent: int) -> None:
    """End if the first process is gone: nobody would tell, nor want what is made."""
    if os.getppid() != parent:
        raise KeyboardInterrupt


def _next_task(tasks: Any, parent: int) -> tuple[int, Part]:
    """Wait for a range, and its number."""
    while True:
        try:
            task: tuple[int, Part] = tasks.get(timeout=PATIENCE)
            return task
        except Empty:
            _watch(parent)


def _work(work: Work, tasks: Any, reports: Any, parent: int) -> None:
    """What a process does: one range after the other, until it is ended."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to all; the first process ends all
    try:
        while True:
            number, part = _next_task(tasks, parent)
            with alone(part.output.track, patience=ORPHANS):
                result = work.solve(part, _Reporter(reports, parent))
            reports.put(("part", number, result))
    except TrimotionError as error:
        reports.put(("error", str(error), error.exit_code))
    except KeyboardInterrupt:
        pass  # the first process tells of it
    except Exception as error:
        if is_out_of_memory(error):
            reports.put(("error", "out of memory; try fewer --jobs, or a smaller source", 1))
            return
        kind = type(error).__name__
        text = f"internal error ({kind}: {error}); run again with --jobs 1 --debug and report it"
        reports.put(("error", text, 1))
