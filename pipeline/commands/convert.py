"""One run of `animate`, `solve` or `render`, and what is told of it."""

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING

from pipeline.commands.importing import importing
from pipeline.options.presets import blamed, read_preset, without_effect

if TYPE_CHECKING:
    from pipeline.loop.result import Animated
    from pipeline.options.job import Job
    from pipeline.options.look import Look
    from pipeline.options.output import Output
    from pipeline.options.run import Run
    from pipeline.progress import Progress
    from stages.media.frame_range import FrameRange


def convert(arguments: argparse.Namespace) -> "Animated":
    """Convert one source, or draw one track.

    Args:
        arguments: What the user gave, with the name of the source or track and of the output;
            options that were left out are absent.
    """
    done = {"animate": _animate, "solve": _solve, "render": _render}[arguments.command]
    with blamed(vars(arguments)):
        return done(arguments)


def check_options(arguments: argparse.Namespace) -> None:
    """Find mistakes in options, which several inputs share, before anything is done.

    Args:
        arguments: As for `convert`, with the names of one of the inputs.

    Raises:
        OptionError: If an option has an impossible value.
    """
    with blamed(vars(arguments)):
        if arguments.command == "render":
            _wanted(arguments)
        elif arguments.command == "solve":
            solve_job(arguments)
        else:
            _job(arguments)


def _animate(arguments: argparse.Namespace) -> "Animated":
    job = _job(arguments)
    _check_report(job.run, job.output, job.solve.source)
    with progress_for(arguments) as progress:
        with importing():
            from pipeline.commands.called import as_called
            from pipeline.farm.runners import runner_for
            from pipeline.loop.animate import animate

        with as_called(arguments, job):
            result = animate(job, progress, runner_for(job.run))
        _tell(progress, result, job.output.path)
        _report(arguments, job, result)
        return result


def _solve(arguments: argparse.Namespace) -> "Animated":
    from pipeline.timeline.mesh_course import with_course

    job = with_course(solve_job(arguments))
    _check_report(job.run, job.output, job.solve.source)
    with progress_for(arguments) as progress:
        with importing():
            from pipeline.commands.called import as_called
            from pipeline.farm.runners import runner_for
            from pipeline.loop.animate import solve

        _tell_left_out(arguments, progress)
        runner = runner_for(job.run)
        with as_called(arguments, job):
            result = solve(job.solve, job.output, job.run, progress, runner=runner)
        _tell(progress, result, job.output.track)
        _report(arguments, job, result)
        return result


def _render(arguments: argparse.Namespace) -> "Animated":
    source = None if arguments.source is None else Path(arguments.source)
    wanted = _wanted(arguments)
    _check_report(wanted[3], wanted[2], Path(arguments.track))
    with importing():
        from pipeline.look.render_job import render_job
        from pipeline.loop.render import render
        from pipeline.track import TrackReader

    with TrackReader(Path(arguments.track)) as track, progress_for(arguments) as progress:
        _tell_left_out(arguments, progress)
        made = render_job(track, *wanted, source)
        for note in made.notes:
            progress.note(note)
        for warning in made.warnings:
            progress.warn(warning)
        result = render(made.job, track, made.info, progress)
        _tell(progress, result, made.job.output.path)
        _report(arguments, made.job, result, made.notes, made.warnings)
        return result


def preview_of(arguments: argparse.Namespace) -> str:
    """Draw a few moments of what `animate` would make.

    Args:
        arguments: What the user gave.

    Returns:
        What is told of it.
    """
    place = arguments.output or ""
    new_folder = Path(place) if place.endswith(("/", os.sep)) else None
    if not place or place.endswith(("/", os.sep)) or os.path.isdir(place):
        place = os.path.join(place, f"{Path(arguments.source).stem}.preview.png")
    with blamed(vars(arguments)):
        job = _job(arguments, output=place)
        return _previewed(arguments, job, new_folder)


def _previewed(arguments: argparse.Namespace, job: "Job", new_folder: Path | None) -> str:
    """Draw the moments of a job, and tell of them."""
    from pipeline.commands.output_folder import output_folder
    from pipeline.commands.pipes import shown_name
    from pipeline.commands.preview_sheet import as_json, make_preview, told

    assert job.output.path is not None
    with output_folder(new_folder), progress_for(arguments) as progress:
        found = make_preview(job, progress)
        for note in found.notes:
            progress.note(note)
    tell = as_json if arguments.json else told
    return tell(found, shown_name(job.output.path))


def solve_job(arguments: argparse.Namespace) -> "Job":
    """What is solved; looks, which a preset may hold, do not belong to a track.

    Args:
        arguments: What the user gave.
    """
    return _job(arguments, track=arguments.output, output=None, styles=(), regions=())


def _wanted(arguments: argparse.Namespace) -> "tuple[FrameRange, Look, Output, Run]":
    """What a track is drawn with."""
    from pipeline.options.build import build_render
    from pipeline.timeline.staging import staged
    from pipeline.track.kind import drawn_ending

    path = Path(arguments.track)
    wanted, look, output, run = build_render(given_by(arguments), path, drawn_ending(path))
    return wanted, staged(look), output, run


def _job(arguments: argparse.Namespace, **fixed: object) -> "Job":
    """The job that the arguments and their preset describe.

    Args:
        arguments: What the user gave.
        fixed: What the command decides itself.
    """
    from pipeline.options.build import build_job
    from pipeline.timeline.staging import with_timeline

    return with_timeline(build_job({**given_by(arguments), **fixed}))


def given_by(arguments: argparse.Namespace) -> dict[str, object]:
    """What the arguments and their preset give.

    Args:
        arguments: What the user gave; options that were left out are absent.
    """
    from pipeline.options.command_line import with_preset

    given = dict(vars(arguments))
    name = given.pop("preset")
    return with_preset(given, read_preset(name) if name else {})


def _tell_left_out(arguments: argparse.Namespace, progress: "Progress") -> None:
    """Note what a preset holds that means nothing here: a preset is for all commands."""
    name = arguments.preset
    note = without_effect(arguments.command, name, read_preset(name)) if name else None
    if note:
        progress.note(note)


def progress_for(arguments: argparse.Namespace) -> "Progress":
    """What tells of a run, as the user wants it.

    Args:
        arguments: What the user gave.
    """
    from pipeline.progress import open_progress

    chosen = "none" if arguments.quiet and arguments.progress == "auto" else arguments.progress
    verbose = arguments.verbose or not (arguments.quiet or chosen == "none")
    return open_progress(chosen, verbose=verbose)


def _tell(progress: "Progress", result: "Animated", output: Path | None) -> None:
    """Tell what came of a run."""
    assert output is not None
    from pipeline.commands.pipes import shown_name
    from pipeline.progress import Summary

    for note in result.notes:
        progress.note(note)
    for warning in result.warnings:
        progress.warn(warning)
    progress.finish(Summary(result.frames, result.seconds, result.mean_rmse, shown_name(output)))


def _check_report(run: "Run", output: "Output", source: Path) -> None:
    """Refuse a report that could not be written, before any work is done."""
    if run.report is not None:
        from pipeline.reporting.place import check_report

        check_report(run, output, source)


def _report(
    arguments: argparse.Namespace,
    job: "Job",
    result: "Animated",
    notes: tuple[str, ...] = (),
    warnings: tuple[str, ...] = (),
) -> None:
    """Write the report of a run, if one is wanted."""
    if job.run.report is None:
        return
    from pipeline.commands.pipes import shown_name, source_name
    from pipeline.reporting.telling import Telling
    from pipeline.reporting.write import write_report

    track = Path(arguments.track) if arguments.command == "render" else job.output.track
    source = track if arguments.command == "render" else job.solve.source
    output = job.output.path or job.output.track
    assert source is not None
    assert output is not None
    names = (source_name(arguments, source), str(shown_name(output)))
    given = given_by(arguments)
    write_report(Telling(arguments.command, given, *names, result, notes, warnings), job, track)
