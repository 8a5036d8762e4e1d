"""Members of a registry as users write them: `edges:width=1.5,color=#222`, `importance:MAP.png`."""

import inspect
import os
import re
from argparse import ArgumentTypeError
from collections.abc import Mapping
from dataclasses import Field, fields
from typing import Any

from pipeline.options.nearest import nearest
from pipeline.options.values import NAMES, kind_of, read_value
from stages.masks.region import Region
from warp_kernels.errors import OptionError


def parse_member(flag: str, text: str, registry: Mapping[str, type]) -> Any:
    """Make a member of a registry from `NAME` or `NAME:KEY=VALUE,...`; messages name the option.

    Raises:
        OptionError: If the name, a parameter or a value is not allowed.
        MediaError: If a picture that is a parameter cannot be read.
    """
    name, colon, rest = text.partition(":")
    try:
        if name not in registry:
            raise OptionError(_no_member(text, registry))
        if colon and not rest.strip():
            raise OptionError(f"nothing follows the colon; write {name}, or {name}:KEY=VALUE,...")
        kinds = {field.name: kind_of(field) for field in parameters(registry[name])}
        return registry[name](**_values(name, rest, kinds))
    except (OptionError, ArgumentTypeError) as error:
        problem = str(error).removeprefix(f"{text}: ")
        raise OptionError(f"{flag} {text}: {problem}") from error


def parse_parameters(
    flag: str, text: str, name: str, rest: str, kinds: Mapping[str, str]
) -> dict[str, Any]:
    """Read `KEY=VALUE,...` of what is no member of a registry; messages name the option.

    Args:
        flag: The option.
        text: All that was given to it.
        name: What has the parameters.
        rest: The part of the text that holds them; empty for none.
        kinds: Their types, see `kind_of`.

    Raises:
        OptionError: If a parameter or a value is not allowed.
    """
    try:
        return _values(name, rest, kinds)
    except (OptionError, ArgumentTypeError) as error:
        raise OptionError(f"{flag} {text}: {error}") from error


def _values(name: str, rest: str, kinds: Mapping[str, str]) -> dict[str, Any]:
    """Values of what follows a name; the first may be a text or a file without its key."""
    first = next(iter(kinds), "")
    takes_bare = kinds.get(first) in NAMES
    if takes_bare and os.path.isfile(rest):
        return {first: read_value(kinds[first], rest)}  # whatever signs its name holds
    values: dict[str, Any] = {}
    for number, item in enumerate(rest.split(",") if rest else []):
        key, equals, value = item.partition("=")
        if number == 0 and takes_bare and not equals:
            key, value = first, item
        elif not (key and equals and value):
            raise OptionError(f"{item!r} is not KEY=VALUE; write name:key=value,...")
        key = key.strip().replace("-", "_")
        if key not in kinds:
            known = f"it has {', '.join(kinds)}" if kinds else "it has none; write the name alone"
            raise OptionError(f"{name} has no parameter {key!r}; {known}")
        if key in values:
            raise OptionError(f"{key} is given twice; give it once")
        values[key] = read_value(kinds[key], value.strip(), key)
    return values


def _no_member(text: str, registry: Mapping[str, type]) -> str:
    """What to say about a specification whose name is none."""
    several = [word for word in re.split(r"[,+;\s]+", text) if word]
    if len(several) > 1 and all(word in registry for word in several):
        return f"{len(several)} names in one; give each by itself: {' and '.join(several)}"
    name, _, rest = text.partition(":")
    owner, equals, value = name.partition("=")
    known = parameters(registry[owner]) if equals and owner in registry else []
    if known:
        pairs = ",".join(filter(None, [f"{known[0].name}={value}", rest]))
        return f"a parameter has its name after a colon; write {owner}:{pairs}"
    return f"no {name!r}; {nearest(name, registry)}"


def parse_region(flag: str, text: str, styles: Mapping[str, type]) -> Region:
    """Make a region of `MASK:STYLE`; the name of the mask may hold colons, see `Region.of`.

    Raises:
        OptionError: If there is no mask or no such style, or what follows @ are no frames.
    """
    parts = text.split(":")
    for number in range(1, len(parts)):
        if parts[number] in styles:
            style = parse_member(flag, ":".join(parts[number:]), styles)
            return Region.of(":".join(parts[:number]), style, flag)
    raise OptionError(
        f"{flag} {text}: write MASK:STYLE, such as mask.png:hatching, or MASK@FRAME:STYLE; styles "
        f"are {', '.join(styles)}"
    )


def parameters(cls: Any) -> list[Field[Any]]:
    """What a member is made with: its own fields, then inherited ones, the nearest first."""
    order = [name for base in cls.__mro__ for name in inspect.get_annotations(base)]
    return sorted((f for f in fields(cls) if f.init), key=lambda field: order.index(field.name))
