"""The registry of styles, as people and programs read it."""

import json
from collections.abc import Iterator

from pipeline.options.declared import (
    NO_DEFAULT,
    DeclaredField,
    declared_registry,
    declared_summary,
    registry_classes,
)

REGISTRY = "warp_kernels.styles:STYLES"
"""Where styles are registered."""
SHARED = ("opacity", "blend")
"""Parameters of every style, listed once."""


def list_styles(*, as_json: bool) -> str:
    """What `--style` takes: every style with its parameters, defaults, units and ranges.

    Args:
        as_json: Whether to give JSON rather than lines.
    """
    module = REGISTRY.partition(":")[0]
    members = declared_registry(REGISTRY)
    summaries = {
        name: declared_summary(module, cls) for name, cls in registry_classes(REGISTRY).items()
    }
    if as_json:
        facts = {
            name: {"summary": summaries[name], "parameters": [_facts(p) for p in parameters]}
            for name, parameters in members.items()
        }
        return json.dumps(facts, indent=2)
    lines = ["--style NAME, or NAME:PARAMETER=VALUE,...; repeat it to lay one over the other", ""]
    for name, parameters in members.items():
        lines.append(f"{name}  {summaries[name]}")
        lines += _rows(p for p in parameters if p.name not in SHARED)
    lines.append("every style")
    lines += _rows(p for p in next(iter(members.values())) if p.name in SHARED)
    return "\n".join(lines)


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
