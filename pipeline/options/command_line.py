"""The options of `animate`: fields, with help, of the dataclasses that are parts of a `Job`."""

import argparse
import reprlib
from argparse import ArgumentTypeError
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass
from fractions import Fraction
from functools import cache, partial
from itertools import chain
from typing import Any

from pipeline.options.look import Look
from pipeline.options.members import written
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.options.values import kind_of, read_value
from warp_kernels.errors import OptionError
from warp_kernels.registry import Registry

HEADINGS = {
    "range": "which frames",
    "triangles": "triangles",
    "motion": "motion",
    "look": "look",
    "time": "change over time",
    "output": "output file",
    "run": "run",
    "processes": "processes",
}
"""Groups of the help, in order, and their titles."""

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
    """Key of its heading in `HEADINGS`."""
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

    @property
    def is_switch(self) -> bool:
        """Whether it stands alone, without a value; it sets its field to what is no default."""
        return self.kind == "bool"

    @property
    def is_repeatable(self) -> bool:
        """Whether every use adds a value."""
        return self.kind.endswith(", ...]")

    def value(self, given: object, what: str, sign: str = " = ") -> object:
        """The value that the command line would give for one of a file or a program.

        Messages begin with `what`, where it stands, and have a sign between that and the value.

        Raises:
            OptionError: If the value is of another kind, or none that the option may have.
        """
        if not self.is_repeatable:
            return self._single(given, what, sign)
        entries = given if isinstance(given, list | tuple) else [given]
        return [self._single(entry, what, sign) for entry in entries]

    def _single(self, given: object, what: str, sign: str) -> object:
        is_plain = isinstance(given, str | int | float | Fraction)
        if not is_plain or isinstance(given, bool) != self.is_switch:
            form = f"a number or a text in quotes, as {self.metavar}"
            form = "true or false" if self.is_switch else form
            raise OptionError(f"{what}{sign}{' '.join(reprlib.repr(given).split())}: write {form}")
        if self.is_switch:
            return given != self.default
        try:
            result = read_value(self.kind, str(given))
        except ArgumentTypeError as error:
            raise OptionError(f"{what}: {error}") from error
        if self.choices and result not in self.choices:
            raise OptionError(f"{what}{sign}{given!r}: choose from {', '.join(self.choices)}")
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

_SOURCE_ONLY = ("track", "resume", "fps", "page", "stream")
"""Options that mean nothing once there is a track."""

COMMAND_OPTIONS: dict[str, Callable[[Option], bool]] = {
    "animate": lambda o: True,
    "solve": lambda o: o.group not in ("look", "output") or o.dest in ("overwrite", "resume"),
    "render": lambda o: (
        (o.group in ("range", "look", "time", "output") and o.dest not in _SOURCE_ONLY)
        or o.dest in ("device", "threads")
    ),
    "preview": lambda o: o.dest not in ("track", "resume", "jobs"),
    "plan": lambda o: o.group == "range" or o.dest == "cuts",
    "measure": lambda o: o in RANGE_OPTIONS,
    "timeline": lambda o: o.dest in ("styles", "regions", "background", "fps"),
}
"""Which options a command has."""


@cache
def job_options() -> tuple[Option, ...]:
    """All options that describe a job."""
    parts = (_options_of(part, group) for part, group in _PARTS.items())
    return (*RANGE_OPTIONS, *chain.from_iterable(parts))


def add_job_options(parser: argparse.ArgumentParser, command: str) -> None:
    """Give a parser the options of a command, in groups; what is not given is absent later."""
    for key, title in HEADINGS.items():
        wanted = [o for o in job_options() if o.group == key and COMMAND_OPTIONS[command](o)]
        if wanted:
            group = parser.add_argument_group(title)
            sizes = group.add_mutually_exclusive_group() if key == "look" else group
            for option in wanted:
                _add(sizes if option.dest in EXCLUSIVE else group, option)


def commands_with(flag: str) -> list[str]:
    """Commands that have an option of a job, by its name; `preview` has those of `animate`."""
    found = [option for option in job_options() if option.flag == flag]
    owners = [name for name, has in COMMAND_OPTIONS.items() if any(map(has, found))]
    return [name for name in owners if name not in ("preview", "timeline")]


def registry_help() -> str:
    """A paragraph that lists the members of every registry, and the parameters of its own."""
    lines = ["members and their parameters (NAME or NAME:KEY=VALUE,KEY=VALUE):"]
    for option in job_options():
        if option.registry is not None:
            own = option.registry.own.items()
            lines += [f"  --{option.flag} {written(name, cls)}" for name, cls in own]
            lines += [f"  --{option.flag} {name} (installed)" for name in option.registry.added]
    return "\n".join(lines)


def with_preset(given: Mapping[str, object], preset: Mapping[str, object]) -> dict[str, object]:
    """Values of a preset, replaced by what the command line gives; both by field name."""
    decided = any(name in given for name in EXCLUSIVE)
    kept = {k: v for k, v in preset.items() if not (decided and k in EXCLUSIVE)}
    return {**kept, **given}


def _add(group: argparse._ActionsContainer, option: Option) -> None:
    more: dict[str, Any] = {"action": "store_false" if option.default else "store_true"}
    if not option.is_switch:
        more = {
            "action": "append" if option.is_repeatable else "store",
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
    if default is MISSING:
        default = said["registry"].name_of(field.default_factory)
    flag, text = said.get("flag", field.name.replace("_", "-")), said["help"]
    if kind != "bool" and default not in (None, ()):
        text += f" (default: {default:g})" if kind == "float" else f" (default: {default})"
    elif kind == "bool" and default:
        flag, text = f"no-{flag}", f"do not {text}"
    usual = {"int": "N", "float": "X"}.get(kind, field.name.split("_")[-1].upper())
    shown = "|".join(said.get("registry", said.get("choices", ()))) or usual
    named = said.get("choices"), said.get("registry")
    return Option(flag, field.name, group, kind, text, said.get("metavar", shown), default, *named)
