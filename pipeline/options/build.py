"""From the values that a user gave to the checked options of a job."""

import dataclasses
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from pipeline.job import Job
from pipeline.options.look import Look
from pipeline.options.members import parse_member, parse_region
from pipeline.options.output import Output
from pipeline.options.output_name import output_in
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from stages.flows import FLOWS
from stages.focus import FOCI
from stages.layouts import LAYOUTS
from stages.media import FrameRange, parse_time
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES


def build_job(given: Mapping[str, Any]) -> Job:
    """Make all options of a run; what is not given takes the default of its dataclass.

    Args:
        given: Values by field name, as the command line or a preset gives them, with the names of
            the `source`, of the `output` if a picture is drawn, and of the `track` if one is
            written.

    Raises:
        OptionError: If a value is impossible.
        MediaError: If a picture that an option names cannot be read.
    """
    return Job(build_solve(given), build_look(given), build_output(given), build_run(given))


def build_solve(given: Mapping[str, Any]) -> SolveOptions:
    """Make what decides meshes; see `build_job`."""
    values = {**given, "source": Path(given["source"]), "frame_range": frame_range(given)}
    for name, registry in (("layout", LAYOUTS), ("flow", FLOWS)):
        if name in given:
            values[name] = parse_member(f"--{name}", given[name], registry)
    foci = given.get("focus", ())
    values["focus"] = tuple(parse_member("--focus", spec, FOCI) for spec in foci)
    _check_cuts(values.get("cuts"))
    options: SolveOptions = fill(SolveOptions, values)
    return options


def build_look(given: Mapping[str, Any]) -> Look:
    """Make what decides pictures; see `build_job`."""
    specs = given.get("styles", ())
    texts = given.get("regions", ())
    values = {
        **given,
        "styles": tuple(parse_member("--style", spec, STYLES) for spec in specs),
        "regions": tuple(parse_region("--region", text, STYLES) for text in texts),
    }
    look: Look = fill(Look, values)
    return look


def build_run(given: Mapping[str, Any]) -> Run:
    """Make what says where the work is done; see `build_job`."""
    run: Run = fill(Run, given)
    return run


def build_render(given: Mapping[str, Any], track: Path) -> tuple[FrameRange, Look, Output, Run]:
    """Make what a track is drawn with.

    Args:
        given: As for `build_job`, without a source.
        track: Names the output where that is a folder.
    """
    values = {**given, "source": track, "track": None}
    build_solve(values)  # a preset may hold such options, and mistakes in them are told
    return frame_range(values), build_look(values), build_output(values), build_run(values)


def build_output(given: Mapping[str, Any]) -> Output:
    """Make what says where the result goes; see `build_job`."""
    values = dict(given)
    if given.get("output") is not None:
        values["path"] = output_in(given["output"], given["source"])
    if given.get("track") is not None:
        values["track"] = output_in(given["track"], given["source"], ".mtrk")
    if given.get("resume"):
        values["overwrite"] = True  # what is drawn from a track replaces what was drawn before
    output: Output = fill(Output, values)
    return output


def frame_range(given: Mapping[str, Any]) -> FrameRange:
    """The range that `--frames`, `--start` and `--end` describe together.

    Args:
        given: Values by name; other names are ignored.

    Raises:
        OptionError: If the range is impossible.
    """
    frames = FrameRange.parse(given["frames"]) if "frames" in given else FrameRange()
    return frames.between(_time(given, "start"), _time(given, "end"))


def fill(cls: type, values: Mapping[str, Any]) -> Any:
    """Make a dataclass and those inside it from one flat table of values.

    Args:
        cls: The dataclass.
        values: Values by field name; every dataclass takes those that it knows.
    """
    arguments = {}
    for field in dataclasses.fields(cls):
        nested = field.default_factory
        if field.name in values:
            arguments[field.name] = values[field.name]
        elif isinstance(nested, type) and "registry" not in field.metadata:
            arguments[field.name] = fill(nested, values)
    return cls(**arguments)


def _time(given: Mapping[str, Any], name: str) -> Fraction | None:
    return parse_time(given[name], f"--{name}") if name in given else None


def _check_cuts(cuts: str | None) -> None:
    if cuts not in (None, "auto", "none") and not Path(str(cuts)).is_file():
        raise OptionError(
            f"--cuts {cuts}: no such file; give auto, none or a file of frame numbers"
        )
