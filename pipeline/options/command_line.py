"""The options of `animate`, derived from what the parts of a `Job` declare."""

import argparse
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from pipeline.options.declared import (
    NO_DEFAULT,
    DeclaredField,
    declared_fields,
    declared_registry,
    registry_classes,
)
from pipeline.options.flags import reader_for, text_value

HEADINGS = {
    "range": "which frames",
    "triangles": "triangles",
    "motion": "motion",
    "look": "look",
    "output": "output file",
    "run": "run",
    "processes": "processes",
}
"""Groups of the help, in order, and their titles."""

_GROUPS = {"Look": "look", "EncodeOptions": "output"}
"""Groups of dataclasses; the others belong to the triangles."""

_PARTS = (
    ("pipeline.options.run", "Run"),
    ("pipeline.options.solve_options", "SolveOptions"),
    ("pipeline.options.look", "Look"),
    ("pipeline.options.output", "Output"),
)
"""The dataclasses that together are a job."""

RANGE_FIELDS = (
    DeclaredField(
        "frames",
        "str",
        "range",
        __name__,
        None,
        {
            "group": "range",
            "help": "frames from 0, both ends included: A-B, A, A- or A-BxS",
            "metavar": "A-B",
        },
    ),
    DeclaredField(
        "start",
        "str",
        "range",
        __name__,
        None,
        {"group": "range", "help": "from this time on: seconds or h:mm:ss", "metavar": "TIME"},
    ),
    DeclaredField(
        "end",
        "str",
        "range",
        __name__,
        None,
        {"group": "range", "help": "up to this time, itself included", "metavar": "TIME"},
    ),
)
"""Options that together make a `FrameRange`."""

EXCLUSIVE = ("output_size", "scale")
"""Options of which one at most may be given."""


@dataclass(frozen=True)
class Option:
    """One option of the command line."""

    flag: str
    """Its name without dashes in front; also its key in a preset."""
    dest: str
    """Name of the field that takes its value."""
    declared: DeclaredField
    """What it was declared as."""

    @property
    def is_switch(self) -> bool:
        """Whether it stands alone, without a value."""
        return self.declared.kind == "bool"

    @property
    def switched(self) -> bool:
        """What a switch sets its field to."""
        return not self.declared.default

    @property
    def is_repeatable(self) -> bool:
        """Whether every use adds a value."""
        return self.declared.kind.endswith(", ...]")

    @property
    def group(self) -> str:
        """Key of its heading in `HEADINGS`."""
        owner = self.declared.owner
        return str(self.declared.metadata.get("group", _GROUPS.get(owner, "triangles")))

    @property
    def read(self) -> Callable[[str], Any]:
        """Reads its value from text."""
        return text_value if self.is_repeatable else reader_for(self.declared.kind)

    @property
    def choices(self) -> tuple[str, ...] | None:
        """The values that it may have, if they can be listed."""
        return self.declared.metadata.get("choices")

    @property
    def help(self) -> str:
        """What it does, with its default."""
        default: object = self.declared.default
        if self.declared.factory:
            default = member_of(self.declared.metadata["registry"], self.declared.factory)
        text = str(self.declared.metadata["help"])
        if self.is_switch and not self.switched:
            text = f"do not {text}"
        if not self.is_switch and default not in (None, (), NO_DEFAULT):
            text += (
                f" (default: {default:g})"
                if isinstance(default, float)
                else (f" (default: {default})")
            )
        return text.replace("%", "%%")

    @property
    def metavar(self) -> str | None:
        """How its value is shown."""
        declared = self.declared
        if "registry" in declared.metadata:
            return (
                "SPEC"
                if self.is_repeatable
                else "|".join(registry_classes(declared.metadata["registry"]))
            )
        if self.choices is not None:
            return "|".join(self.choices)
        if "metavar" in declared.metadata:
            return str(declared.metadata["metavar"])
        kinds = {"int": "N", "float": "X"}
        return kinds.get(
            declared.kind.removesuffix(" | None"), declared.name.split("_")[-1].upper()
        )


_SOURCE_ONLY = ("track", "resume", "fps", "page", "stream")
"""Options that mean nothing once there is a track."""

COMMAND_OPTIONS: dict[str, Callable[[Option], bool]] = {
    "animate": lambda option: True,
    "solve": lambda option: (
        option.group not in ("look", "output") or option.dest in ("overwrite", "resume")
    ),
    "render": lambda option: (
        (option.group in ("range", "look", "output") and option.dest not in _SOURCE_ONLY)
        or option.dest in ("device", "threads")
    ),
    "plan": lambda option: option.group == "range" or option.dest == "cuts",
    "measure": lambda option: option.declared in RANGE_FIELDS,
}
"""Which options a command has."""


@cache
def job_options() -> tuple[Option, ...]:
    """All options that describe a job; a name that several dataclasses share is one option."""
    options = [Option(declared.name, declared.name, declared) for declared in RANGE_FIELDS]
    known = {option.dest for option in options}
    for declared in (field for part in _PARTS for field in _fields_of(*part)):
        if declared.name not in known:
            known.add(declared.name)
            options.append(Option(_flag_of(declared), declared.name, declared))
    return tuple(options)


def add_job_options(
    parser: argparse.ArgumentParser, wanted: Callable[[Option], bool] = lambda option: True
) -> None:
    """Give a parser options of a job; what is not given does not appear in the result.

    Args:
        parser: Takes the options, in groups.
        wanted: Which options; all, if left out.
    """
    for key, title in HEADINGS.items():
        options = [option for option in job_options() if option.group == key and wanted(option)]
        if options:
            group = parser.add_argument_group(title)
            sizes = group.add_mutually_exclusive_group() if key == "look" else group
            for option in options:
                _add(sizes if option.dest in EXCLUSIVE else group, option)


def add_range_options(parser: argparse.ArgumentParser) -> None:
    """Give a parser the options of a frame range alone.

    Args:
        parser: Takes the options.
    """
    group = parser.add_argument_group(HEADINGS["range"])
    for declared in RANGE_FIELDS:
        _add(group, Option(declared.name, declared.name, declared))


def commands_with(flag: str) -> list[str]:
    """Commands that have an option of a job.

    Args:
        flag: Its name without dashes in front.
    """
    found = [option for option in job_options() if option.flag == flag]
    return [name for name, has in COMMAND_OPTIONS.items() if any(map(has, found))]


def registry_help() -> str:
    """A paragraph that lists the members of every registry with their parameters."""
    lines = ["members and their parameters (NAME or NAME:KEY=VALUE,KEY=VALUE):"]
    for option in job_options():
        reference = option.declared.metadata.get("registry")
        if reference is not None:
            for name, parameters in declared_registry(reference).items():
                lines.append(f"  --{option.flag} {name}{_parameters(parameters)}")
    return "\n".join(lines)


def with_preset(given: Mapping[str, object], preset: Mapping[str, object]) -> dict[str, object]:
    """Values of a preset, replaced by what the command line gives.

    Args:
        given: Values from the command line by field name.
        preset: Values from the preset by field name.
    """
    decided = any(name in given for name in EXCLUSIVE)
    kept = {k: v for k, v in preset.items() if not (decided and k in EXCLUSIVE)}
    return {**kept, **given}


def _add(group: argparse._ActionsContainer, option: Option) -> None:
    common: dict[str, Any] = {
        "dest": option.dest,
        "default": argparse.SUPPRESS,
        "help": option.help,
    }
    if option.is_switch:
        action = "store_true" if option.switched else "store_false"
        group.add_argument(f"--{option.flag}", action=action, **common)
        return
    group.add_argument(
        f"--{option.flag}",
        action="append" if option.is_repeatable else "store",
        type=option.read,
        choices=option.choices,
        metavar=option.metavar,
        **common,
    )


def _fields_of(module: str, name: str) -> Iterator[DeclaredField]:
    """Fields with help of a dataclass and of the dataclasses inside it."""
    for declared in declared_fields(module, name):
        if "help" in declared.metadata:
            yield declared
        elif declared.factory:
            yield from _fields_of(declared.module, declared.factory)


def _flag_of(declared: DeclaredField) -> str:
    flag = str(declared.metadata.get("flag", declared.name.replace("_", "-")))
    return f"no-{flag}" if declared.kind == "bool" and declared.default is True else flag


def member_of(registry: str, cls: str) -> str:
    """Name of a registry's member.

    Args:
        registry: Module and name, such as `stages.flows:FLOWS`.
        cls: Name of the member's class.
    """
    return next(name for name, other in registry_classes(registry).items() if other == cls)


def _parameters(parameters: tuple[DeclaredField, ...]) -> str:
    """Parameters as they are written in a specification, with their defaults."""
    shown = []
    for declared in parameters:
        default = declared.default
        shown.append(f"{declared.name}={'FILE' if default is None else default}")
    return ":" + ",".join(shown) if shown else ""
