"""Members of registries, also those that packages add, as people and programs read them."""

import inspect
import json
import os
from collections.abc import Iterable, Iterator
from dataclasses import MISSING, Field
from typing import Any

from pipeline.options.command_line import job_options
from pipeline.options.members import parameters
from pipeline.options.nearest import nearest
from pipeline.options.values import kind_of
from stages.moves import MOVES
from warp_kernels.errors import OptionError
from warp_kernels.registry import Registry
from warp_kernels.styles import STYLES, Style

SHARED = ("opacity", "blend")
"""Parameters of every style, listed once."""


def list_styles(only: str | None = None, *, as_json: bool) -> str:
    """What `--style` and `--move` take: every member with its parameters, defaults and ranges.

    What installed packages add to other options follows; a member that cannot be used is told with
    the reason.

    Args:
        only: The style or the move that is told of; None for all.
        as_json: Whether to give JSON rather than lines.

    Raises:
        OptionError: If there is no such style, or the one that is asked for cannot be used.
    """
    if only is not None:
        _check(only, [*STYLES, *MOVES])
        family: Registry[Any] = STYLES if only in STYLES else MOVES
        family[only]
        if as_json:
            return json.dumps({only: _member_facts(family, only)}, indent=2)
        return "\n".join(_member(family, only))
    if as_json:
        found: dict[str, object] = {name: _member_facts(STYLES, name) for name in STYLES}
        return json.dumps(found | _other_facts(), indent=2)
    lines = ["--style NAME, or NAME:PARAMETER=VALUE,...; repeat it to lay one over the other", ""]
    for name in STYLES:
        lines += _member(STYLES, name, without=SHARED)
    lines.append("every style")
    lines += _rows(p for p in parameters(Style) if p.name in SHARED)
    lines += ["", "--move NAME, or NAME:PARAMETER=VALUE,...; repeat it to add one to the other", ""]
    for name in MOVES:
        lines += _member(MOVES, name)
    for flag, registry in _extended():
        lines += ["", f"{flag}, from installed packages"]
        for name in registry.added:
            lines += _member(registry, name)
    return "\n".join(lines)


def _extended() -> Iterator[tuple[str, Registry[Any]]]:
    """Options besides `--style` and `--move` to which installed packages add members."""
    for option in job_options():
        registry = option.registry
        # by identity: equal registries are those of equal members, which would all be imported
        is_other = registry is not STYLES and registry is not MOVES
        if registry is not None and is_other and registry.added:
            yield f"--{option.flag}", registry


def registry_help() -> str:
    """A paragraph that lists the members of every registry, and the parameters of its own."""
    lines = ["members and their parameters (NAME or NAME:KEY=VALUE,KEY=VALUE):"]
    for option in job_options():
        if option.registry is not None:
            own = option.registry.own.items()
            lines += [f"  --{option.flag} {_written(name, cls)}" for name, cls in own]
            lines += [f"  --{option.flag} {name} (installed)" for name in option.registry.added]
    return "\n".join(lines)


def _member(registry: Registry[Any], name: str, without: tuple[str, ...] = ()) -> list[str]:
    """A member and its parameters, or why it cannot be used."""
    try:
        cls = registry[name]
    except OptionError as error:
        return [f"{name}  cannot be used: {error}"]
    origin = f" [{registry.origin(name)}]" if name in registry.added else ""
    rows = _rows(p for p in parameters(cls) if p.name not in without)
    return [f"{name}  {_summary(cls)}{origin}", *rows]


def _other_facts() -> dict[str, object]:
    """Moves, and what packages add to other options, by flag; no style has such a name."""
    moves = {name: _member_facts(MOVES, name) for name in MOVES}
    added: dict[str, object] = {
        flag: {name: _member_facts(registry, name) for name in registry.added}
        for flag, registry in _extended()
    }
    return {"--move": moves} | added


def _member_facts(registry: Registry[Any], name: str) -> dict[str, object]:
    """A member for programs."""
    try:
        cls = registry[name]
    except OptionError as error:
        return {"error": str(error)}
    return {"summary": _summary(cls), "parameters": [_facts(p) for p in parameters(cls)]}


def _summary(cls: type) -> str:
    """First line of what a class says about itself."""
    return (inspect.getdoc(cls) or "").split("\n", maxsplit=1)[0]


def _check(name: str, members: Iterable[str]) -> None:
    """Refuse what is no style; it may be a picture, which only a sheet shows."""
    if name in members:
        return
    if os.path.isfile(name):
        raise OptionError(
            f"styles {name}: is a file, not a style; to draw it in every style add --sheet OUT.png"
        )
    raise OptionError(f"styles {name}: no such style; {nearest(name, members)}")


def _rows(parameters: Iterator[Field[Any]]) -> list[str]:
    """One line for each parameter."""
    return [f"    {_given(p):<20} {_told(p)}" for p in parameters]


def _given(parameter: Field[Any]) -> str:
    """A parameter with its default, as it is written."""
    return f"{parameter.name}{_shown(parameter)}"


def _written(name: str, cls: Any) -> str:
    """A member with its parameters and their defaults, as it would be given."""
    values = (f"{p.name}{_shown(p)}" for p in parameters(cls))
    return ":".join(filter(None, [name, ",".join(values)]))


def _shown(parameter: Field[Any]) -> str:
    """What follows the name of a parameter that is left as it is."""
    default = parameter.default
    if default is None and kind_of(parameter) in ("float", "int"):
        return ""
    if default in (None, MISSING):
        return "=FILE"
    return f"={default:g}" if isinstance(default, float) else f"={default}"


def _told(parameter: Field[Any]) -> str:
    """What it does, its unit and what it may be."""
    metadata = parameter.metadata
    text = str(metadata.get("help", ""))
    if "unit" in metadata:
        text += f" [{metadata['unit']}]"
    if "range" in metadata:
        least, most = metadata["range"]
        text += f", {least:g} to {most:g}"
    if "choices" in metadata:
        text += f": {', '.join(metadata['choices'])}"
    return text


def _facts(parameter: Field[Any]) -> dict[str, object]:
    """A parameter for programs."""
    return {"name": parameter.name, "default": parameter.default, **parameter.metadata}
