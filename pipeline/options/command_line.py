"""The options of `animate`: fields, with help, of the dataclasses that are parts of a `Job`."""

import argparse
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass
from fractions import Fraction
from functools import cache, partial
from typing import Any

from pipeline.options.look import Look
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.options.values import kind_of, read_value
from pipeline.options.written import in_file
from warp_kernels.errors import OptionError
from warp_kernels.registry import Registry

GROUPS = ("range", "triangles", "motion", "look", "time", "output", "run", "processes")
"""Groups of the help, in order."""
_TITLES = {"range": "which frames", "time": "change over time", "output": "output file"}
"""Headings of those whose own name would not do."""

_PARTS = {Run: "run", SolveOptions: "triangles", Look: "look", Output: "output"}
"""The dataclasses that together are a job, and the groups of fields that name none."""

EXCLUSIVE = ("output_size", "scale")
"""Options of which one at most may be given."""


@dataclass(frozen=True)
class Option:
    """A field with help of one of the dataclasses of a job, as an option of the command line."""

    flag: str
    """Its name without dashes in front; also its key in a preset."""
    dest: str
    """Name of the field that takes its value."""
    group: str
    """One of `GROUPS`."""
    kind: str
    """Type of the field, such as `int`; `bool` is a switch, which stands alone."""
    help: str
    """What it does, with its default."""
    metavar: str
    """How its value is shown."""
    default: Any = None
    """What is taken if it is not given, as it would be written."""
    choices: tuple[str, ...] | None = None
    """The values that it may have, if they are few."""
    registry: Registry[Any] | None = None
    """The family whose members it names."""
    is_single: bool = False
    """Whether two of it are a mistake; else the last one counts."""

    @property
    def is_switch(self) -> bool:
        """Whether it stands alone, without a value; it sets its field to what is no default."""
        return self.kind == "bool"

    @property
    def is_repeatable(self) -> bool:
        """Whether every use adds a value."""
        return self.kind.endswith(", ...]")

    def value(self, given: object, what: str, written: Callable[[object], str] = in_file) -> object:
        """The value that the command line would give for one of a file or a program.

        Messages begin with `what`, where it stands; the value follows as it is written there.

        Raises:
            OptionError: If the value is of another kind, or none that the option may have.
        """
        if not self.is_repeatable:
            return self._single(given, what, written)
        entries = given if isinstance(given, list | tuple) else [given]
        return [self._single(entry, what, written) for entry in entries]

    def _single(self, given: object, what: str, written: Callable[[object], str]) -> object:
        shown = what + written(given)
        if self.is_switch:
            if not isinstance(given, bool):
                raise OptionError(f"{shown}: write true or false")
            return given != self.default
        if isinstance(given, bool) or not isinstance(given, str | int | float | Fraction):
            raise OptionError(f"{shown}: write a number or a text in quotes, as {self.metavar}")
        try:
            result = read_value(self.kind, str(given))
        except argparse.ArgumentTypeError as error:
            raise OptionError(f"{what}: {error}") from error
        if self.choices and result not in self.choices:
            raise OptionError(f"{shown}: choose from {', '.join(self.choices)}")
        return result


RANGE_OPTIONS = tuple(
    Option(name, name, "range", "str", text, form)
    for name, text, form in (
        ("frames", "frames from 0, both ends included: A-B, A, A- or A-BxS", "A-B"),
        ("start", "from this time on: seconds or h:mm:ss", "TIME"),
        ("end", "up to this time, itself included", "TIME"),
    )
)
"""Options that together make a `FrameRange`."""

_SOLVING = {
    *("triangles", "motion", "processes", "track", "resume", "fps", "page", "stream", "limits"),
    "decoder",
    "seed",
    "loop",
}
"""Groups and options that mean nothing once there is a track."""

_HEARD = ("audio_mode", "audio_offset", "beats")
_SOLVED_WITH = ("overwrite", "resume", "report", *_HEARD)
"""Options of an output that a track has, and those that say what a timeline hears."""

_NOT_EDITED = ("track", "resume", "overwrite", "loop", "timeline", "cluster", *_HEARD)
"""Options that mean nothing for a track that is edited."""

_ONCE = ("jobs", "cluster", "resume", "report", "loop")
"""Options of one run that solves all."""

_NOT_PREVIEWED = ("track", "resume", "report", "jobs", "cluster", "edits", "loop")
"""Options that mean nothing for a few moments."""

_LOOKED_AT = ("styles", "regions", "palette", "grade", "background", "fps", *_HEARD)
"""Options that say what a timeline may change, and when."""

COMMAND_OPTIONS: dict[str, Callable[[Option], bool]] = {
    "animate": lambda o: True,
    "solve": lambda o: o.group not in ("look", "output") or o.dest in _SOLVED_WITH,
    "render": lambda o: not _SOLVING & {o.group, o.dest},
    "edit": lambda o: o.group not in ("look", "output") and o.dest not in _NOT_EDITED,
    "preview": lambda o: o.dest not in _NOT_PREVIEWED,
    "plan": lambda o: COMMAND_OPTIONS["solve"](o) and o.dest not in _ONCE,
    "measure": lambda o: o in RANGE_OPTIONS,
    "timeline": lambda o: o.dest in _LOOKED_AT,
}
"""Which options a command has."""


@cache
def job_options() -> tuple[Option, ...]:
    """All options that describe a job."""
    found = (option for part in _PARTS.items() for option in _options_of(*part))
    return (*RANGE_OPTIONS, *found)


def add_job_options(parser: argparse.ArgumentParser, command: str) -> None:
    """Give a parser the options of a command, in groups; what is not given is absent later."""
    groups = {name: parser.add_argument_group(_TITLES.get(name, name)) for name in GROUPS}
    sizes = groups["look"].add_mutually_exclusive_group()
    wanted = filter(COMMAND_OPTIONS[command], job_options())
    for option in sorted(wanted, key=lambda option: GROUPS.index(option.group)):
        _add(sizes if option.dest in EXCLUSIVE else groups[option.group], option)


def with_preset(given: Mapping[str, object], preset: Mapping[str, object]) -> dict[str, object]:
    """Values of a preset, replaced by what the command line gives; both by field name."""
    beaten = EXCLUSIVE if any(name in given for name in EXCLUSIVE) else ()
    return {**{key: preset[key] for key in preset if key not in beaten}, **given}


class _Once(argparse.Action):
    """An option that is refused if it is given twice: nobody means the last one alone."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: object,
        option_string: str | None = None,
    ) -> None:
        if hasattr(namespace, self.dest):
            both = f"{getattr(namespace, self.dest)} and {values}"
            raise argparse.ArgumentError(self, f"is given twice, {both}; leave one out")
        setattr(namespace, self.dest, values)


def _add(group: argparse._ActionsContainer, option: Option) -> None:
    more: dict[str, Any] = {"action": "store_false" if option.default else "store_true"}
    if not option.is_switch:
        more = {
            "action": _Once if option.is_single else "append" if option.is_repeatable else "store",
            "type": partial(read_value, option.kind),
            "choices": option.choices,
            "metavar": option.metavar,
        }
    more |= {"default": argparse.SUPPRESS, "help": option.help.replace("%", "%%")}
    group.add_argument(f"--{option.flag}", dest=option.dest, **more)


def _options_of(cls: Any, group: str) -> Iterator[Option]:
    """Options of a dataclass and of the dataclasses inside it."""
    for field in fields(cls):
        if "help" in field.metadata:
            yield _option(field, field.metadata.get("group", group))
        elif is_dataclass(field.type):
            yield from _options_of(field.type, group)


def _option(field: Field[Any], group: str) -> Option:
    """What the metadata of a field say, see `pipeline.options.job`, and what they leave open."""
    said, kind, default = field.metadata, kind_of(field), field.default
    registry, choices = said.get("registry"), said.get("choices")
    if default is MISSING:
        default = said["registry"].name_of(field.default_factory)
    flag, text = said.get("flag", field.name.replace("_", "-")), said["help"]
    if kind == "bool" and default:
        flag, text = f"no-{flag}", f"do not {text}"
    elif kind != "bool" and default not in (None, ()):
        text += (
            f" (default: {default:g})" if isinstance(default, float) else f" (default: {default})"
        )
    usual = {"int": "N", "float": "X"}.get(kind, field.name.split("_")[-1].upper())
    metavar = said.get("metavar", "|".join(registry or choices or [usual]))
    is_single = bool(said.get("is_single"))
    return Option(
        flag, field.name, group, kind, text, metavar, default, choices, registry, is_single
    )
