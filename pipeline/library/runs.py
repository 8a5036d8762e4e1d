"""`animate`, `solve`, `render` and `measure` as functions: the commands, with options as keywords.

What is heavy is imported by the calls.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack, cast

from pipeline.library.given import file_name, given_values
from pipeline.library.keywords import (
    AnimateKeywords,
    Name,
    RangeKeywords,
    RenderKeywords,
    SolveKeywords,
)
from pipeline.library.log import log_result
from pipeline.library.processes import check_processes, explained_loss
from pipeline.library.progress import Told, progress_for
from pipeline.library.result import Result
from pipeline.library.signature import with_keywords
from pipeline.library.wording import in_keywords, worded
from pipeline.progress import Progress, Summary

if TYPE_CHECKING:
    from pipeline.compare.report import Report
    from pipeline.loop.result import Animated
    from pipeline.options.job import Job
    from pipeline.options.output import Output
    from pipeline.options.run import Run


@with_keywords("animate")
@worded()
def animate(
    source: Name, output: Name, *, progress: Told = None, **options: Unpack[AnimateKeywords]
) -> Result:
    """Convert a video, a still or numbered stills into triangles, as `trimotion animate` does.

    Args:
        source: What FFmpeg reads, or a pattern such as `shot_####.png`.
        output: mp4, mov, mkv, webm, gif, a still, or a pattern; appears when all is done.
        progress: None for silence, True for a bar or lines on the error stream, or a function
            that is given a `FrameDone` for every frame; what it raises ends the run.
        options: See below.

    Raises:
        TrimotionError: One of its kinds; the message is one line that ends with a remedy.
    """
    job = _job("animate", source, options, output=file_name("output", output))
    with progress_for(progress) as told, explained_loss(job.run.jobs):
        from pipeline.farm.runners import runner_for
        from pipeline.loop.animate import animate as run

        _check_report(job.run, job.output, job.solve.source)
        animated = run(job, told, runner_for(job.run))
        result = _result(Path(job.solve.source), animated, job.output.path, told)
        _report("animate", options, job, job.solve.source, result, animated)
        return result


@with_keywords("solve")
@worded()
def solve(
    source: Name, output: Name, *, progress: Told = None, **options: Unpack[SolveKeywords]
) -> Result:
    """Convert a source to a mesh track, from which any look can be drawn.

    Args:
        source: What FFmpeg reads, or a pattern such as `shot_####.png`.
        output: The track, `NAME.mtrk`; it keeps what was solved if the run is interrupted.
        progress: See `animate`.
        options: See below.

    Raises:
        TrimotionError: One of its kinds; the message is one line that ends with a remedy.
    """
    # Looks, which a preset may hold, do not belong to a track.
    fixed = {"track": file_name("output", output), "styles": (), "regions": (), "moves": ()}
    job = _job("solve", source, options, **fixed)
    with progress_for(progress) as told, explained_loss(job.run.jobs):
        from pipeline.farm.runners import runner_for
        from pipeline.loop.animate import solve as run
        from pipeline.timeline.mesh_course import with_course

        job = with_course(job)
        _check_report(job.run, job.output, job.solve.source)
        solved = run(job.solve, job.output, job.run, told, runner=runner_for(job.run))
        result = _result(Path(job.solve.source), solved, job.output.track, told)
        _report("solve", options, job, job.solve.source, result, solved)
        return result


@with_keywords("render")
@worded()
def render(
    track: Name,
    output: Name,
    *,
    source: Name | None = None,
    progress: Told = None,
    **options: Unpack[RenderKeywords],
) -> Result:
    """Draw a mesh track, or a part of it, in any style and size.

    Args:
        track: A file that `solve` wrote.
        output: What `animate` writes.
        source: Where the source is now, if it was moved and is needed.
        progress: See `animate`.
        options: See below.

    Raises:
        TrimotionError: One of its kinds; the message is one line that ends with a remedy.
    """
    moved = None if source is None else Path(file_name("source", source))
    path, target = Path(file_name("track", track)), file_name("output", output)
    given = given_values("render", options)
    from pipeline.look.render_job import render_job
    from pipeline.loop.render import render as draw
    from pipeline.options.build import build_render
    from pipeline.timeline.staging import staged
    from pipeline.track import TrackReader
    from pipeline.track.kind import drawn_ending

    frames, look, written, run = build_render({**given, "output": target}, path, drawn_ending(path))
    _check_report(run, written, path)
    with TrackReader(path) as reader, progress_for(progress) as told:
        made = render_job(reader, frames, staged(look), written, run, moved)
        drawn = draw(made.job, reader, made.info, told)
        result = _result(path, drawn, made.job.output.path, told, made.notes, made.warnings)
        _report("render", options, made.job, path, result, drawn)
        return result


@with_keywords("measure")
@worded()
def measure(
    source: Name,
    output: Name,
    *,
    track: Name | None = None,
    progress: Told = None,
    **options: Unpack[RangeKeywords],
) -> "Report":
    """Compare an output with its source, frame by frame.

    Args:
        source: What was converted.
        output: What came out; scaled to the source's size if it has another.
        track: The track from which it was drawn, if its meshes are to be measured.
        progress: See `animate`.
        options: See below.

    Raises:
        TrimotionError: One of its kinds; the message is one line that ends with a remedy.
    """
    from pipeline.compare.measure import measure as compare
    from pipeline.options.build import frame_range

    wanted = frame_range(given_values("measure", options))
    names = Path(file_name("source", source)), Path(file_name("output", output))
    held = None if track is None else Path(file_name("track", track))
    with progress_for(progress) as told:
        return compare(*names, wanted, held, told)


def _job(function: str, source: Name, options: Mapping[str, Any], **fixed: object) -> "Job":
    """The job that a call describes.

    Args:
        function: What was called.
        source: Its source.
        options: Its keywords.
        fixed: What the function decides itself.
    """
    fixed = {"source": file_name("source", source), **fixed}
    values = given_values(function, options)
    check_processes(cast(int, values.get("jobs", 1)))
    from pipeline.options.build import build_job
    from pipeline.timeline.staging import with_timeline

    return with_timeline(build_job({**values, **fixed}))


def _result(
    source: Path,
    animated: "Animated",
    output: Path | None,
    told: Progress,
    notes: tuple[str, ...] = (),
    warnings: tuple[str, ...] = (),
) -> Result:
    """What came of a run, told to those who want to be."""
    assert output is not None
    result = Result(
        output=output,
        frames=animated.frames,
        seconds=animated.seconds,
        mean_rmse=animated.mean_rmse,
        notes=tuple(in_keywords(note) for note in (*notes, *animated.notes)),
        warnings=tuple(in_keywords(text) for text in (*warnings, *animated.warnings)),
    )
    log_result(source, result)
    for text in result.warnings:
        told.warn(text)
    told.finish(Summary(result.frames, result.seconds, result.mean_rmse, output))
    return result


def _check_report(run: "Run", output: "Output", source: Path) -> None:
    """Refuse a report that could not be written, before any work is done."""
    if run.report is not None:
        from pipeline.reporting.place import check_report

        check_report(run, output, source)


def _report(
    function: str,
    options: Mapping[str, Any],
    job: "Job",
    source: Path,
    result: Result,
    animated: "Animated",
) -> None:
    """Write the report of a run, if one is wanted; its sentences are those of the result."""
    if job.run.report is None:
        return
    from pipeline.reporting.telling import Telling
    from pipeline.reporting.write import write_report

    given, track = given_values(function, options), job.output.track
    told = replace(animated, notes=result.notes, warnings=result.warnings)
    telling = Telling(function, given, str(source), str(result.output), told)
    write_report(telling, job, source if function == "render" else track)
