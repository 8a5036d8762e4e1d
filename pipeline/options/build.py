"""From the values that a user gave to a checked `Job`."""

import dataclasses
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from pipeline.job import Job
from pipeline.options.members import parse_member, parse_region
from pipeline.options.output_name import output_in
from stages.flows import FLOWS
from stages.focus import FOCI
from stages.layouts import LAYOUTS
from stages.media import FrameRange, parse_time
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES


def build_job(given: Mapping[str, Any]) -> Job:
    """Make a job; what is not given takes the default of its dataclass.

    Args:
        given: Values by field name, as the command line or a preset gives them.

    Raises:
        OptionError: If a value is impossible.
        MediaError: If a picture that an option names cannot be read.
    """
    values = dict(given)
    values["source"] = Path(given["source"])
    values["output"] = output_in(given["output"], given["source"])
    values["frame_range"] = frame_range(given)
    if given.get("track") is not None:
        values["track"] = output_in(given["track"], given["source"], ".mtrk")
    if given.get("resume"):
        values["overwrite"] = True  # what is drawn from a track replaces what was drawn before
    for name, registry in (("layout", LAYOUTS), ("flow", FLOWS)):
        if name in given:
            values[name] = parse_member(f"--{name}", given[name], registry)
    foci = given.get("focus", ())
    values["focus"] = tuple(parse_member("--focus", spec, FOCI) for spec in foci)
    specs = given.get("styles", ())
    values["styles"] = tuple(parse_member("--style", spec, STYLES) for spec in specs)
    regions = given.get("regions", ())
    values["regions"] = tuple(parse_region("--region", text, STYLES) for text in regions)
    _check_cuts(values.get("cuts"))
    job: Job = fill(Job, values)
    return job


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
