"""What a report tells: all of it as plain values, in the order of `docs/report.schema.json`."""

import os
import platform
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from fractions import Fraction
from math import isfinite
from typing import Any

from pipeline.loop.result import Animated, TalliedFrame
from pipeline.options.command_line import COMMAND_OPTIONS, job_options
from pipeline.options.edit_log import EditLog
from pipeline.version import library_versions, program_version

VERSION = 1
"""Of the JSON; it grows when a key changes its meaning or goes, not when one is added."""
DIGITS = 6
"""Decimals of seconds."""


@dataclass(frozen=True)
class Telling:
    """A finished run that is to be told of."""

    command: str
    """`animate`, `solve` or `render`."""
    given: Mapping[str, Any]
    """What the user gave, by field name."""
    source: str
    """What was converted or drawn, as the user calls it."""
    output: str
    """What was written, likewise."""
    result: Animated
    """What it came to."""
    notes: tuple[str, ...] = ()
    """Choices that were made before it began, one sentence each."""
    warnings: tuple[str, ...] = ()
    """Damage that was met before it began, one sentence each."""

    def as_dict(self) -> dict[str, Any]:
        """All of it, as JSON holds it."""
        result = self.result
        frames = list(_frames(result.figures))
        return {
            "format": "trimotion report",
            "version": VERSION,
            "command": self.command,
            "source": self.source,
            "output": self.output,
            "summary": {
                "frames": result.frames,
                "seconds": round(result.seconds, DIGITS),
                "mean_rmse": result.mean_rmse,
                "cuts": [one["frame"] for one in frames if one["cut"]],
            },
            "seconds_by_stage": {name: round(s, DIGITS) for name, s in result.stages},
            "busy_seconds": {name: round(s, DIGITS) for name, s in result.busy.items()},
            "peak_memory": {"process": result.memory, "largest_worker": result.memory_apart},
            "warnings": [*self.warnings, *result.warnings],
            "notes": [*self.notes, *result.notes],
            "options": _options(self.command, self.given),
            "versions": {
                "trimotion": program_version(),
                "python": platform.python_version(),
                "system": platform.platform(),
                **library_versions(),
            },
            "frames": frames,
        }


def _frames(figures: tuple[TalliedFrame, ...]) -> Iterator[dict[str, Any]]:
    """Frames, with what follows from the one before."""
    shot = figures[0].shot if figures else None
    for one in figures:
        known = asdict(one)
        known["seconds"] = round(one.seconds, DIGITS)
        yield {**known, "cut": one.shot != shot}
        shot = one.shot


def _options(command: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """Every option of a command with its value, given or not."""
    found: dict[str, Any] = {}
    for option in filter(COMMAND_OPTIONS[command], job_options()):
        value = given.get(option.dest, option.default)
        if option.is_switch:
            value = value != option.default
        found[option.flag] = _plain(value)
    return found


def _plain(value: object) -> object:
    """A value as JSON can hold it."""
    if isinstance(value, float) and not isfinite(value):
        return str(value)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, EditLog):
        return f"{len(value.edits)} edits"
    if isinstance(value, os.PathLike | Fraction):
        return str(value)
    return type(value).__name__
