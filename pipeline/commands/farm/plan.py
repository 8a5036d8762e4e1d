"""`trimotion plan`: ranges of a film, or the job of a farm that solves them."""

import argparse
from pathlib import Path

from pipeline.commands.convert import given_by, solve_job
from pipeline.commands.pipes import source_name
from pipeline.farm.farm_job import FarmJob
from pipeline.farm.formats import ENGINES
from pipeline.loop.plan import LEAD, Pieces, Plan, plan
from pipeline.options.command_line import COMMAND_OPTIONS, job_options
from pipeline.options.presets import blamed
from pipeline.options.words import as_words
from pipeline.track.resume import check_track_name
from warp_kernels.errors import OptionError

NOT_SOLVED_WITH = ("frames", "start", "end", "overwrite")
"""Options of `plan` that the commands of a job do not have, or have for every part."""


def planned(arguments: argparse.Namespace) -> str:
    """What `plan` prints.

    Args:
        arguments: What the user gave.

    Raises:
        OptionError: If an option is impossible, or there is no frame.
        MediaError: If the source cannot be read.
    """
    form = "json" if arguments.json else arguments.format
    output = arguments.output or f"{Path(arguments.source).stem}.mtrk"
    check_track_name(Path(output))
    with blamed(vars(arguments)):
        job = solve_job(argparse.Namespace(**{**vars(arguments), "output": output}))
    pieces = _pieces(arguments)
    found = plan(job.solve, arguments.parts, pieces)
    if form not in ENGINES:
        called = source_name(arguments, found.source)
        return found.as_json(called) if form == "json" else found.as_lines()
    return ENGINES[form](_farmed(arguments, found, Path(output), job.run.threads)).rstrip("\n")


def _farmed(arguments: argparse.Namespace, found: Plan, track: Path, threads: int) -> FarmJob:
    """What a farm does for a plan."""
    given = given_by(arguments)
    wanted = (option for option in job_options() if COMMAND_OPTIONS["plan"](option))
    return FarmJob(
        source=found.source.absolute(),
        track=track.absolute(),
        ranges=found.ranges,
        options=tuple(as_words(given, (o for o in wanted if o.dest not in NOT_SOLVED_WITH))),
        blend=_blend(arguments, found),
        replaces=bool(given.get("overwrite")),
        threads=threads,
    )


def _pieces(arguments: argparse.Namespace) -> Pieces | None:
    """How long shots are cut."""
    if arguments.max_frames is not None:
        return Pieces(arguments.max_frames, LEAD if arguments.lead is None else arguments.lead)
    if arguments.lead is not None:
        raise OptionError(f"--lead {arguments.lead}: nothing is cut; give --max-frames, too")
    return None


def _blend(arguments: argparse.Namespace, found: Plan) -> int:
    """Frames over which parts fade into each other: all that they have in common."""
    pieces = _pieces(arguments)
    return pieces.lead if pieces is not None and len(found.ranges) > len(found.shots) else 0
