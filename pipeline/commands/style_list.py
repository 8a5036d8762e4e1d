"""The registry of styles, as people and programs read it."""

import json
from collections.abc import Iterable, Iterator
from pathlib import Path

from pipeline.options.declared import (
    NO_DEFAULT,
    DeclaredField,
    declared_registry,
    declared_summary,
    registry_classes,
)
from pipeline.options.nearest import nearest
from warp_kernels.errors import OptionError

REGISTRY = "warp_kernels.styles:STYLES"
"""Where styles are registered."""
SHARED = ("opacity", "blend")
"""Parameters of every style, listed once."""


def list_styles(only: str | None = None, *, as_json: bool) -> str:
    """What `--style` takes: every style with its parameters, defaults, units and ranges.

    Args:
        only: The style that is told of; None for all.
        as_json: Whether to give JSON rather than lines.

    Raises:
        OptionError: If there is no such style.
    """
    module = REGISTRY.partition(":")[0]
    members = declared_registry(REGISTRY)
    if only is not None:
        _check(only, members)
    wanted = {name: members[name] for name in members if only in (None, name)}
    classes = registry_classes(REGISTRY)
    summaries = {name: declared_summary(module, classes[name]) for name in wanted}
    if as_json:
        facts = {
            name: {"summary": summaries[name], "parameters": [_facts(p) for p in parameters]}
            for name, parameters in wanted.items()
        }
        return json.dumps(facts, indent=2)
    if only is not None:
        rows = _rows(iter(wanted[only]))
        return "\n".join([f"{only}  {summaries[only]}", *rows])
    lines = ["--style NAME, or NAME:PARAMETER=VALUE,...; repeat it to lay one over the other", ""]
    for name, parameters in wanted.items():
        lines.append(f"{name}  {summaries[name]}")
        lines += _rows(p for p in parameters if p.name not in SHARED)
    lines.append("every style")
    lines += _rows(p for p in next(iter(members.values())) if p.name in SHARED)
    return "\n".join(lines)


def _check(name: str, members: Iterable[str]) -> None:
    """Refuse what is no style; it may be a picture, which only a sheet shows."""
    if name in members:
        return
    if Path(name).is_file():
        raise OptionError(
            f"styles {name}: is a file, not a style; to draw it in every style add --sheet OUT.png"
        )
    raise OptionError(f"styles {name}: no such style; {nearest(name, members)}")


def _rows(parameters: Iterator[DeclaredField]) -> list[str]:
    """One line for each parameter."""
    return [f"    {_given(p):<20} {_told(p)}" for p in parameters]


def _given(parameter: DeclaredField) -> str:
    """A parameter with its default, as it is written."""
    default = parameter.default
    shown = f"{default:g}" if isinstance(default, float) else str(default)
    return f"{parameter.name}={'FILE' if default in (None, NO_DEFAULT) else shown}"


def _told(parameter: DeclaredField) -> str:
    """What it does, its unit and what it may be."""
    metadata = parameter.metadata
    text = str(metadata["help"])
    if "unit" in metadata:
        text += f" [{metadata['unit']}]"
    if "range" in metadata:
        least, most = metadata["range"]
        text += f", {least:g} to {most:g}"
    if "choices" in metadata:
        text += f": {', '.join(metadata['choices'])}"
    return text


def _facts(parameter: DeclaredField) -> dict[str, object]:
    """A parameter for programs."""
    return {"name": parameter.name, "default": parameter.default, **parameter.metadata}
