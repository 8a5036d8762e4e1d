"""`--jobs N`: shots solved by N processes, each to a track of its own, joined at the end."""

import multiprocessing
import os
import shutil
import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from multiprocessing.process import BaseProcess
from pathlib import Path
from queue import Empty
from time import perf_counter
from typing import Any

import numpy as np

from pipeline.job import Job
from pipeline.look.drawing import check_drawing
from pipeline.look.region_masks import check_followed
from pipeline.look.render_job import render_job
from pipeline.loop.animate import Animated, render, solve
from pipeline.loop.plan import plan
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import TrackReader, join, refuse_track
from pipeline.track.resume import check_track_place
from pipeline.track.schema import ENDING
from stages.media import FrameRange, probe
from stages.media.writing.commit import PendingFile
from warp_kernels.device.kernel_cache import settle_cache
from warp_kernels.energy.color_model import ColorModel
from warp_kernels.errors import OptionError, OutputError, TrimotionError

PATIENCE = 0.5
"""How often the processes are looked after [s]."""


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


def animate_in_parts(job: Job, progress: Progress) -> Animated:
    """Solve shots side by side, then draw them.

    Also in one process where regions are followed: they reach back to frames before their mask's.

    Args:
        job: What to do.
        progress: Told of the whole: a frame is half done when it is solved, and done when drawn.

    Raises:
        TrimotionError: As `animate` does.
    """
    begun = perf_counter()
    both = _Halves(progress)
    options, output = job.solve, job.output
    assert output.path is not None
    refuse_track(options.source)
    info = probe(options.source, read=options.read)
    check_followed(job, info)
    check_drawing(job, info)
    if output.track is None and output.resume:
        raise OptionError("--resume: nothing is left to go on with; name a --track FILE.mtrk")
    track = output.track or PendingFile(output.path).path.with_suffix(ENDING)
    try:
        solved = solve_in_parts(options, replace(output, track=track), job.run, both, job.fitted)
        with TrackReader(track) as reader:
            wanted, source = options.frame_range, options.source
            drawn = render_job(reader, wanted, job.look, output, job.run, source)
            both.second_half()
            result = render(drawn.job, reader, drawn.info, both)
    finally:
        if output.track is None:
            track.unlink(missing_ok=True)
            shutil.rmtree(_folder(track), ignore_errors=True)
    return replace(
        result,
        seconds=perf_counter() - begun,
        warnings=(*solved.warnings, *result.warnings),
        notes=(*solved.notes, *result.notes),
    )


def solve_in_parts(
    options: SolveOptions,
    output: Output,
    run: Run,
    progress: Progress,
    fitted: ColorModel | None = None,
) -> Animated:
    """Solve shots side by side; the track is that of one process, to the bit.

    Args:
        options: What decides the meshes.
        output: Names the track.
        run: What the work may use.
        progress: Told of every finished frame.
        fitted: The colour model of the snapshots, if a look needs more than the optimised one.

    Raises:
        TrimotionError: As `solve` does.
    """
    assert output.track is not None
    begun = perf_counter()
    check_track_place(output.track, output)
    alone = replace(run, jobs=1)
    if run.jobs == 1 or (output.resume and output.track.exists()):
        # what is resumed goes on inside a shot
        return solve(options, output, alone, progress, fitted)
    ranges = plan(options).ranges
    if len(ranges) == 1:
        return solve(options, output, alone, progress, fitted)
    folder = _made_folder(output)
    settle_cache()  # once for all processes
    crew = _Crew(_Work(options, run, fitted), ranges, folder, progress)
    with crew.at_work():
        crew.wait()
    join([_path(folder, part) for part in ranges], output.track, options.frame_range)
    with TrackReader(output.track) as reader:
        mean = float(np.mean([row.rmse for row in reader.rows]))
    shutil.rmtree(folder, ignore_errors=True)
    notes = list(crew.notes)
    if len(ranges) < run.jobs:
        notes.append(f"{len(ranges)} shots: so many processes, not {run.jobs}")
    return Animated(crew.done, perf_counter() - begun, mean, tuple(crew.warnings), tuple(notes))


@dataclass(frozen=True)
class _Work:
    """What the processes have in common."""

    options: SolveOptions
    run: Run
    fitted: ColorModel | None


class _Crew:
    """Processes that take ranges from a queue and report on another."""

    def __init__(
        self, work: _Work, ranges: Sequence[FrameRange], folder: Path, progress: Progress
    ) -> None:
        self.done = 0
        """Frames finished by this run."""
        self.notes: dict[str, None] = {}
        """Choices that were made, each once."""
        self.warnings: dict[str, None] = {}
        """Damage that was met, each once."""
        self._progress = progress
        self._left = len(ranges)
        self._total = sum((part.last or 0) - part.first + part.step for part in ranges)
        self._total //= ranges[0].step
        self._found = sum(_held(_path(folder, part)) for part in ranges)
        context = multiprocessing.get_context("spawn")
        self._tasks: Any = context.Queue()
        self._reports: Any = context.Queue()
        longest = sorted(ranges, key=lambda part: part.first - (part.last or 0))
        for part in longest:
            self._tasks.put((part, _path(folder, part)))
        count = min(work.run.jobs, len(ranges))
        threads = work.run.threads or max(1, (os.cpu_count() or 1) // count)
        mine = replace(work, run=replace(work.run, threads=threads, jobs=1))
        self._processes: list[BaseProcess] = [
            context.Process(
                target=_work, args=(mine, self._tasks, self._reports, os.getpid()), daemon=True
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

    def wait(self) -> None:
        """Hear reports until every range is finished.

        Raises:
            PartError: If a process fails or dies.
        """
        while self._left:
            try:
                kind, *values = self._reports.get(timeout=PATIENCE)
            except Empty:
                self._look_after()
                continue
            if kind == "kernels":
                self._progress.kernels(*values)
            elif kind == "frame":
                self.done += 1
                self._progress.frame(self._found + self.done, self._total, *values)
            elif kind == "error":
                raise PartError(*values)
            else:
                self._left -= 1
                self.notes.update(dict.fromkeys(values[0]))
                self.warnings.update(dict.fromkeys(values[1]))

    def _look_after(self) -> None:
        for process in self._processes:
            if process.exitcode is not None and self._reports.empty():
                raise LostPartError(
                    f"a process of --jobs died (code {process.exitcode}); go on with --resume, "
                    "and fewer --jobs if memory was short",
                    1,
                )


class _Halves(Progress):
    """One progress of two passes over the same frames, of which each counts for a half."""

    def __init__(self, whole: Progress) -> None:
        super().__init__()
        self._whole = whole
        self._is_second = False
        self._told = 0

    def second_half(self) -> None:
        """The first pass is over."""
        self._is_second = True

    def kernels(self, done: int, total: int | None) -> None:
        """Tell how far compiling is."""
        self._whole.kernels(done, total)

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Tell of a frame whenever two halves are finished."""
        together = done if total is None or not self._is_second else done + total
        if together // 2 > self._told:
            self._told = together // 2
            self._whole.frame(self._told, total, triangles, rmse)


class _Reporter(Progress):
    """Tells the first process of frames; ends when that one is gone."""

    def __init__(self, reports: Any, parent: int) -> None:
        super().__init__()
        self._reports = reports
        self._parent = parent

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Tell that a frame is finished."""
        _watch(self._parent)
        self._reports.put(("frame", triangles, rmse))

    def kernels(self, done: int, total: int | None) -> None:
        """Tell how far compiling is."""
        self._reports.put(("kernels", done, total))


def _watch(parent: int) -> None:
    """End if the first process is gone: nobody would tell, nor want what is made."""
    if os.getppid() != parent:
        raise KeyboardInterrupt


def _next_task(tasks: Any, parent: int) -> tuple[FrameRange, Path]:
    """Wait for a range and the track that it is solved to."""
    while True:
        try:
            task: tuple[FrameRange, Path] = tasks.get(timeout=PATIENCE)
            return task
        except Empty:
            _watch(parent)


def _work(work: _Work, tasks: Any, reports: Any, parent: int) -> None:
    """What a process does: one range after the other, until it is ended."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to all; the first process ends all
    try:
        while True:
            wanted, path = _next_task(tasks, parent)
            part = replace(work.options, frame_range=wanted)
            output = Output(track=path, resume=True)
            reporter = _Reporter(reports, parent)
            done = solve(part, output, work.run, reporter, work.fitted)
            reports.put(("part", done.notes, done.warnings))
    except TrimotionError as error:
        reports.put(("error", str(error), error.exit_code))
    except KeyboardInterrupt:
        pass  # the first process tells of it
    except MemoryError:
        reports.put(("error", "out of memory; try fewer --jobs, or a smaller source", 1))
    except Exception as error:
        kind = type(error).__name__
        text = f"internal error ({kind}: {error}); run again with --jobs 1 --debug and report it"
        reports.put(("error", text, 1))


def _held(path: Path) -> int:
    """Frames that an interrupted run left in the track of a part."""
    if not path.exists():
        return 0
    with TrackReader(path) as reader:
        return len(reader.rows)


def _folder(track: Path) -> Path:
    """Where the tracks of the parts lie until they are joined."""
    return track.with_name(f"{track.name}.parts")


def _path(folder: Path, part: FrameRange) -> Path:
    return folder / f"{part}{ENDING}"


def _made_folder(output: Output) -> Path:
    """Make the folder of the parts, or take what an interrupted run left in it."""
    assert output.track is not None
    folder = _folder(output.track)
    if folder.exists() and not output.resume:
        if not output.overwrite:
            raise OutputError(
                folder, "holds parts of an interrupted job", "--resume that, or --overwrite it"
            )
        shutil.rmtree(folder, ignore_errors=True)
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        reason = str(error.strerror or error).lower()
        raise OutputError(folder, f"cannot be made ({reason})", "check the folder") from error
    return folder
