"""What parameters of a member of a registry may be: their metadata say it, and it is checked here.

    help       what it does
    unit       its unit, if it has one
    range      least and largest value
    choices    the texts that it may be
    form       `color`: written #rgb, #rrggbb or a name of CSS

A parameter that may be None is none of these then.
"""

from dataclasses import fields
from typing import Any

from warp_kernels.errors import OptionError
from warp_kernels.styles.color import parse_color


def check_parameters(member: Any) -> None:
    """Refuse parameters that are out of their range.

    Args:
        member: A dataclass of parameters.

    Raises:
        OptionError: If one is.
    """
    name = type(member).__name__.lower()
    for parameter in fields(member):
        value = getattr(member, parameter.name)
        problem = _problem(value, **parameter.metadata)
        if problem:
            shown = f"{value:g}" if isinstance(value, float) else value
            raise OptionError(f"{name}:{parameter.name}={shown}: {problem}")


def _problem(
    value: Any,
    *,
    range: tuple[float, float] | None = None,
    choices: tuple[str, ...] | None = None,
    form: str = "",
    unit: str = "",
    help: str = "",
) -> str:
    """What is wrong with a value, or nothing."""
    if value is None:
        return ""
    if range is not None and not range[0] <= value <= range[1]:
        return f"must lie between {range[0]:g} and {range[1]:g} {unit}".rstrip()
    if choices is not None and value not in choices:
        return f"choose from {', '.join(choices)}"
    if form == "color":
        parse_color(value)
    return ""
