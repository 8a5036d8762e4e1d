"""From the values that a user gave to the checked options of a job."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pipeline.options.command_line import job_options
from pipeline.options.job import Job
from pipeline.options.look import Look
from pipeline.options.members import parse_member, parse_region
from pipeline.options.output import Output
from pipeline.options.output_name import output_in
from pipeline.options.run import Run
from pipeline.options.tones import parse_grade, parse_palette
from stages.media.frame_range import FrameRange
from warp_kernels.registry import imported
from warp_kernels.styles import STYLES

Part = TypeVar("Part")


def build_job(given: Mapping[str, Any]) -> Job:
    """Make all options of a run from what a user gave, see `values_of`."""
    return fill(Job, values_of(given))


def build_render(
    given: Mapping[str, Any], track: Path, ending: str
) -> tuple[FrameRange, Look, Output, Run]:
    """Make what a track is drawn with; it names the output, with an ending, in a folder."""
    output = output_in(given["output"], track, ending)
    job = build_job({**given, "output": str(output), "source": track, "track": None})
    return job.solve.frame_range, job.look, job.output, job.run


def values_of(given: Mapping[str, Any]) -> dict[str, Any]:
    """Values of fields from what a user gave.

    Args:
        given: Values by field name, as the command line or a preset gives them, with the name of
            the `source`, of the `output` if a picture is drawn, of the `track` if one is written.

    Raises:
        OptionError: If a value is impossible.
        MediaError: If a picture that an option names cannot be read.
    """
    values = {**given, "frame_range": frame_range(given)}
    if "source" in given:
        source = values["source"] = Path(given["source"])
        for name, field, ending in (("output", "path", None), ("track", "track", ".mtrk")):
            named = values.pop(name, None)
            if named is not None:
                values[field] = output_in(named, source, ending)
    if isinstance(values.get("edits"), str):
        read_log = imported("pipeline.edit_log.read:read_log")
        values["edits"] = read_log(Path(values["edits"]))
    if given.get("resume"):
        values["overwrite"] = True  # what is drawn from a track replaces what was drawn before
    for option in job_options():
        if option.registry is not None and option.dest in given:
            specs = given[option.dest] if option.is_repeatable else [given[option.dest]]
            found = [parse_member(f"--{option.flag}", spec, option.registry) for spec in specs]
            values[option.dest] = tuple(found) if option.is_repeatable else found[0]
    regions = given.get("regions", ())
    values["regions"] = tuple(parse_region("--region", text, STYLES) for text in regions)
    for name, read in (("grade", parse_grade), ("palette", parse_palette)):
        if given.get(name) is not None:
            values[name] = read(given[name])
    return values


def fill(cls: type[Part], values: Mapping[str, Any]) -> Part:
    """Make a dataclass and those inside it, each of the values that it knows by field name."""
    arguments = {}
    for field in dataclasses.fields(cls):  # type: ignore[arg-type]
        if field.name in values:
            arguments[field.name] = values[field.name]
        elif isinstance(field.type, type) and dataclasses.is_dataclass(field.type):
            arguments[field.name] = fill(field.type, values)
    return cls(**arguments)


def frame_range(given: Mapping[str, Any]) -> FrameRange:
    """The range that `--frames`, `--start` and `--end` describe together."""
    return FrameRange.parse(given.get("frames", "0-"), given.get("start"), given.get("end"))
