"""Video in, triangulated video out: `animate` and `solve` can do every job, and choose how.

Solving turns frames into snapshots, drawing turns snapshots into frames. `animate` does both,
`solve` the first and `pipeline.loop.render` the second, with a mesh track in between.
"""

from collections.abc import Iterable
from dataclasses import replace
from time import perf_counter

import numpy as np

from pipeline.edit_log.painted_regions import PaintedRegions, painted_regions
from pipeline.look.outputs import check_output_of
from pipeline.look.region_masks import check_followed
from pipeline.look.render_job import render_job
from pipeline.loop.convert import convert
from pipeline.loop.edit_frames import with_unreached
from pipeline.loop.parts_folder import make_folder, parts_of, remove_folder
from pipeline.loop.plan import Plan, plan
from pipeline.loop.processes import InProcesses
from pipeline.loop.ranges import InThisProcess, Part, RangeRunner, Work
from pipeline.loop.render import drawn
from pipeline.loop.result import Animated
from pipeline.loop.seam import with_seam
from pipeline.options.job import Job
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.stage_times import added
from pipeline.timeline.mesh_course import with_course
from pipeline.track import TrackReader, join, refuse_track
from pipeline.track.resume import check_track_place
from pipeline.track.schema import ENDING
from stages.media import FrameRange, probe
from stages.media.writing.alone import alone
from stages.media.writing.commit import PendingFile
from warp_kernels.color_model import ColorModel
from warp_kernels.device.memory import peak_memory
from warp_kernels.errors import OptionError


def animate(job: Job, progress: Progress, runner: RangeRunner | None = None) -> Animated:
    """Convert a source.

    Nothing is written under the output's name unless the whole job succeeds; a track that the
    job writes beside it keeps every frame that was solved.

    Args:
        job: What to do.
        progress: Told of every finished frame.
        runner: Who solves; as the job's `jobs` say if left out.

    Raises:
        MediaError: If the source or the map of weights cannot be read.
        OptionError: If an option does not fit the source.
        OutputError: If the output cannot be written.
        TrackError: If the track to go on with cannot be.
    """
    runner = runner or runner_of(job.run)
    job = with_course(job)
    job = replace(job, solve=with_seam(job.solve))
    with alone(job.output.path, job.output.track):
        is_followed = job.look.followed or _painted(job.solve, progress).regions
        if runner.places > 1 or is_followed or job.solve.seam.over:
            return _solved_then_drawn(job, progress, runner)
        return with_unreached(job.solve, convert(job, job.fitted, progress))


def solve(
    options: SolveOptions,
    output: Output,
    run: Run,
    progress: Progress,
    fitted: ColorModel | None = None,
    runner: RangeRunner | None = None,
) -> Animated:
    """Solve a source and write the mesh track alone; it is the same to the bit whoever solves it.

    Args:
        options: What decides the meshes.
        output: Names the track.
        run: What the work may use.
        progress: Told of every finished frame.
        fitted: The colour model of the snapshots, if a look needs more than the optimised one.
        runner: Who solves; as `run.jobs` says if left out.

    Raises:
        MediaError: If the source cannot be read.
        OptionError: If an option does not fit the source.
        OutputError: If the track cannot be written.
        TrackError: If the track to go on with cannot be.
    """
    runner, options = runner or runner_of(run), with_seam(options)
    with alone(output.track):
        _painted(options, progress)
        return _solved(options, output, run, progress, fitted, runner)


def _painted(options: SolveOptions, progress: Progress) -> PaintedRegions:
    """What edits give a style; what of it cannot be drawn is told before hours of work."""
    found = painted_regions(options.edits)
    for text in found.refused:
        progress.warn(text)
    return found


def _solved(
    options: SolveOptions,
    output: Output,
    run: Run,
    progress: Progress,
    fitted: ColorModel | None,
    runner: RangeRunner,
) -> Animated:
    """Solve, in one go or in ranges."""
    work = Work(options, replace(run, jobs=1), fitted or options.model)
    planned = _planned(options, output, runner)
    if planned is not None:
        result = _joined(work, planned, output, runner, progress)
    else:
        (result,) = runner.run(work, [Part(options.frame_range, output)], progress)
    return with_unreached(options, result)


def runner_of(run: Run) -> RangeRunner:
    """Who solves ranges on this machine.

    Args:
        run: Says how many processes there may be.
    """
    return InProcesses(run.jobs) if run.jobs > 1 else InThisProcess()


def _planned(options: SolveOptions, output: Output, runner: RangeRunner) -> Plan | None:
    """Which shots are solved apart, if there are places for several; else None."""
    if runner.places == 1 or output.track is None:
        return None
    check_track_place(output.track, output)
    if output.resume and output.track.exists():
        return None  # what is resumed goes on inside a shot
    planned = plan(options)
    return planned if len(planned.ranges) > 1 else None


def _joined(
    work: Work, planned: Plan, output: Output, runner: RangeRunner, progress: Progress
) -> Animated:
    """Let ranges be solved, and put their tracks together."""
    begun = perf_counter()
    track = output.track
    assert track is not None
    make_folder(track, resume=output.resume, overwrite=output.overwrite)
    parts = parts_of(planned.ranges, track)
    results = runner.run(work, parts, progress)
    tracks = [part.output.track for part in parts if part.output.track is not None]
    join(tracks, track, work.options.frame_range)
    with TrackReader(track) as reader:
        mean = float(np.mean([row.rmse for row in reader.rows]))
    remove_folder(track)
    told = (note for result in results for note in result.notes)
    notes = _each_once([*planned.notes, *told])
    if len(parts) < runner.places:
        notes = (*notes, f"{len(parts)} shots: so many processes, not {runner.places}")
    warnings = _each_once(text for result in results for text in result.warnings)
    frames, seconds = sum(result.frames for result in results), perf_counter() - begun
    figures = tuple(figure for result in results for figure in result.figures)
    return Animated(
        frames,
        seconds,
        mean,
        warnings,
        notes,
        figures,
        stages=(("solving", seconds),),
        busy=added(result.busy for result in results),
        memory=peak_memory(),
        memory_apart=max((result.memory or 0 for result in results), default=0) or None,
    )


def _each_once(texts: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(texts))


def _solved_then_drawn(job: Job, progress: Progress, runner: RangeRunner) -> Animated:
    """Solve all, then draw all: a frame is half done when it is solved, and done when drawn.

    Where shots are solved side by side, and where regions are followed: these reach back to frames
    before their mask's.
    """
    begun = perf_counter()
    both = _Halves(progress)
    options, output, seam = job.solve, job.output, job.solve.seam
    wanted = FrameRange(seam.opens, seam.closes) if seam.over else options.frame_range
    job = replace(job, solve=replace(options, frame_range=wanted))
    assert output.path is not None
    refuse_track(options.source)
    info = probe(options.source, read=options.read)
    check_followed(job, info)
    check_output_of(job, info, options.triangulate.refine.most)
    if output.track is None and output.resume:
        raise OptionError("--resume: nothing is left to go on with; name a --track FILE.mtrk")
    track = output.track or PendingFile(output.path).path.with_suffix(ENDING)
    try:
        kept = replace(output, track=track)
        fitted = replace(job, look=painted_regions(options.edits).over(job.look)).fitted
        solved = _solved(options, kept, job.run, both, fitted, runner)
        with TrackReader(track) as reader:
            made = render_job(reader, wanted, job.look, output, job.run, options.source)
            both.second_half()
            result = drawn(made.job, reader, made.info, both)
    finally:
        if output.track is None:
            track.unlink(missing_ok=True)
            remove_folder(track)
    return replace(
        result,
        seconds=perf_counter() - begun,
        warnings=(*solved.warnings, *result.warnings),
        notes=_each_once([*solved.notes, *result.notes]),
        stages=(("solving", solved.seconds), ("drawing", result.seconds)),
        busy=added((solved.busy, result.busy)),
        memory_apart=solved.memory_apart,
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
