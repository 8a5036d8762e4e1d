"""The options of `animate`: fields, with help, of the dataclasses that are parts of a `Job`."""

import argparse
import reprlib
from argparse import ArgumentTypeError
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields
from fractions import Fraction
from functools import cache, partial
from typing import Any, cast

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
    """Type of the field, such as `int | None`."""
    default: Any
    """What is taken if it is not given, as it would be written."""
    metadata: Mapping[str, Any]
    """What the field says; see `pipeline.options.job`."""

    @property
    def is_switch(self) -> bool:
        """Whether it stands alone, without a value."""
        return self.kind == "bool"

    @property
    def switched(self) -> bool:
        """What a switch sets its field to."""
        return not self.default

    @property
    def is_repeatable(self) -> bool:
        """Whether every use adds a value."""
        return self.kind.endswith(", ...]")

    @property
    def registry(self) -> Registry[Any] | None:
        """The family whose members it names."""
        return self.metadata.get("registry")

    @property
    def help(self) -> str:
        """What it does, with its default."""
        text = str(self.metadata["help"])
        if self.is_switch:
            return text if self.switched else f"do not {text}"
        shown = f"{self.default:g}" if isinstance(self.default, float) else self.default
        return text if self.default in (None, ()) else f"{text} (default: {shown})"

    @property
    def metavar(self) -> str:
        """How its value is shown."""
        if self.registry is not None:
            return "SPEC" if self.is_repeatable else "|".join(self.registry)
        if "choices" in self.metadata:
            return "|".join(self.metadata["choices"])
        kinds = {"int": "N", "float": "X"}
        usual = kinds.get(self.kind.removesuffix(" | None"), self.dest.split("_")[-1].upper())
        return str(self.metadata.get("metavar", usual))

    def value(self, given: object, what: str, sign: str = " = ") -> object:
        """The value that the command line would give for one of a file or a program.

        Messages begin with `what`, where it stands, and have a sign between that and the value.

        Raises:
            OptionError: If the value is of another kind, or none that the option may have.
        """
        if self.is_switch:
            if isinstance(given, bool):
                return given == self.switched
            raise OptionError(f"{what}{sign}{given!r}: write true or false")
        if self.is_repeatable:
            entries = given if isinstance(given, list | tuple) else [given]
            return [self._single(entry, what, sign) for entry in entries]
        return self._single(given, what, sign)

    def _single(self, given: object, what: str, sign: str) -> object:
        if isinstance(given, bool) or not isinstance(given, str | int | float | Fraction):
            shown = " ".join(reprlib.repr(given).split())
            form = f"write a number or a text in quotes, as {self.metavar}"
            raise OptionError(f"{what}{sign}{shown}: {form}")
        try:
            result = read_value(self.kind, str(given))
        except ArgumentTypeError as error:
            raise OptionError(f"{what}: {error}") from error
        choices = self.metadata.get("choices", (result,))
        if result not in choices:
            raise OptionError(f"{what}{sign}{given!r}: choose from {', '.join(choices)}")
        return result


RANGE_OPTIONS = tuple(
    Option(name, name, "range", "str", None, {"help": text, "metavar": form})
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
}
"""Which options a command has."""


@cache
def job_options() -> tuple[Option, ...]:
    """All options that describe a job; a name that several dataclasses share is one option."""
    found = {option.dest: option for option in RANGE_OPTIONS}
    for part, group in _PARTS.items():
        for option in _options_of(part, group):
            found.setdefault(option.dest, option)
    return tuple(found.values())


def add_job_options(
    parser: argparse.ArgumentParser, wanted: Callable[[Option], bool] = lambda option: True
) -> None:
    """Give a parser options of a job, in groups; what is not given is absent from the result."""
    for key, title in HEADINGS.items():
        options = [option for option in job_options() if option.group == key and wanted(option)]
        if options:
            group = parser.add_argument_group(title)
            sizes = group.add_mutually_exclusive_group() if key == "look" else group
            for option in options:
                _add(sizes if option.dest in EXCLUSIVE else group, option)


def commands_with(flag: str) -> list[str]:
    """Commands that have an option of a job, by its name; `preview` has those of `animate`."""
    found = [option for option in job_options() if option.flag == flag]
    owners = [name for name, has in COMMAND_OPTIONS.items() if any(map(has, found))]
    return [name for name in owners if name != "preview"]


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
    more: dict[str, Any] = {"action": "store_true" if option.switched else "store_false"}
    if not option.is_switch:
        more = {
            "action": "append" if option.is_repeatable else "store",
            "type": partial(read_value, option.kind),
            "choices": option.metadata.get("choices"),
            "metavar": option.metavar,
        }
    more |= {"default": argparse.SUPPRESS, "help": option.help.replace("%", "%%")}
    group.add_argument(f"--{option.flag}", dest=option.dest, **more)


def _options_of(cls: Any, group: str) -> Iterator[Option]:
    """Options of a dataclass and of the dataclasses inside it."""
    for field in fields(cls):
        made, default, kind = cast(Any, field.default_factory), field.default, kind_of(field)
        if "registry" in field.metadata and made is not MISSING:
            default = field.metadata["registry"].name_of(made)
        if "help" in field.metadata:
            flag = str(field.metadata.get("flag", field.name.replace("_", "-")))
            flag = f"no-{flag}" if kind == "bool" and default is True else flag
            own = field.metadata.get("group", group)
            yield Option(flag, field.name, own, kind, default, field.metadata)
        elif isinstance(made, type):
            yield from _options_of(made, group)
