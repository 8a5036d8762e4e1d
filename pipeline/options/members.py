"""Members of a registry as users write them: `edges:width=1.5,color=#222`, `importance:MAP.png`."""

import inspect
import re
from collections.abc import Mapping
from dataclasses import Field, fields
from pathlib import Path
from typing import Any

from pipeline.options.nearest import nearest
from pipeline.options.values import NAMES, kind_of, rule_for
from stages.masks.region import Region
from stages.media.naming import input_pattern
from warp_kernels.errors import OptionError

_FRAMES = re.compile(r"[0-9]+(,[0-9]+)*")


def parse_member(flag: str, text: str, registry: Mapping[str, type]) -> Any:
    """Make a member of a registry.

    Args:
        flag: The option, for messages, such as `--style`.
        text: `NAME`, `NAME:KEY=VALUE,...`; a value without a key is the first parameter's.
        registry: Classes by name.

    Raises:
        OptionError: If the name, a parameter or a value is not allowed.
        MediaError: If a picture that is a parameter cannot be read.
    """
    name, _, rest = text.partition(":")
    if name not in registry:
        raise OptionError(f"{flag} {text}: {_no_member(text, registry)}")
    cls: Any = _class_of(f"{flag} {text}", name, registry)
    kinds = {field.name: kind_of(field).removesuffix(" | None") for field in parameters(cls)}
    values: dict[str, Any] = {}
    for key, value in _pairs(flag, text, rest, kinds):
        if key not in kinds:
            known = f"it has {', '.join(kinds)}" if kinds else "it has none; write the name alone"
            raise OptionError(f"{flag} {text}: {name} has no parameter {key!r}; {known}")
        if key in values:
            raise OptionError(f"{flag} {text}: {key} is given twice; give it once")
        values[key] = _convert(f"{flag} {text}: {key}", value, kinds[key])
    try:
        return cls(**values)
    except OptionError as error:
        problem = str(error).removeprefix(f"{text}: ")
        raise OptionError(f"{flag} {text}: {problem}") from error


def _no_member(text: str, registry: Mapping[str, type]) -> str:
    """What to say about a specification whose name is none."""
    name, _, rest = text.partition(":")
    owner, equals, value = name.partition("=")
    if equals and owner in registry:
        first = next(iter(parameters(registry[owner])), None)
        if first is not None:
            written = ",".join(filter(None, [f"{first.name}={value}", rest]))
            return f"a parameter has its name after a colon; write {owner}:{written}"
    return f"no {name!r}; {nearest(name, registry)}"


def parse_region(flag: str, text: str, styles: Mapping[str, type]) -> Region:
    """Make a region.

    Args:
        flag: The option, for messages, such as `--region`.
        text: `MASK:STYLE` or `MASK@FRAME,FRAME,...:STYLE`; the name of the mask may hold colons.
        styles: Styles by name.

    Raises:
        OptionError: If there is no mask or no such style, or what follows @ are no frames.
        MediaError: If a picture that is a parameter cannot be read.
    """
    parts = text.split(":")
    for number in range(1, len(parts)):
        if parts[number] in styles:
            style = parse_member(flag, ":".join(parts[number:]), styles)
            mask, frames = _mask_and_frames(flag, ":".join(parts[:number]))
            return Region(mask, style, frames)
    raise OptionError(
        f"{flag} {text}: write MASK:STYLE, such as mask.png:hatching, or MASK@FRAME:STYLE; styles "
        f"are {', '.join(styles)}"
    )


def _class_of(what: str, name: str, registry: Mapping[str, type]) -> type:
    """The class of a member; that of another package may not be there as it should."""
    try:
        return registry[name]
    except OptionError as error:
        raise OptionError(f"{what}: {error}") from error


def _mask_and_frames(flag: str, text: str) -> tuple[str, tuple[int, ...]]:
    """A mask and the frames that it was drawn for, unless the whole is the name of a file."""
    mask, _, frames = text.rpartition("@")
    if not mask or _is_there(text):
        return text, ()
    if _FRAMES.fullmatch(frames):
        return mask, tuple(sorted({int(frame) for frame in frames.split(",")}))
    if _is_there(mask):
        raise OptionError(
            f"{flag} {text}: {frames!r} are no frames; after @ stand their numbers, such as "
            "MASK@57 or MASK@57,120"
        )
    return text, ()


def _is_there(name: str) -> bool:
    """Whether a name is that of a file or of numbered stills."""
    pattern = input_pattern(name)
    return Path(name).exists() if pattern is None else bool(pattern.numbers())


def parameters(cls: Any) -> list[Field[Any]]:
    """What a member is made with: its own fields, then those that it inherits, the nearest first.

    Args:
        cls: Its class, a dataclass.
    """
    order = [name for base in cls.__mro__ for name in inspect.get_annotations(base)]
    return sorted((f for f in fields(cls) if f.init), key=lambda field: order.index(field.name))


def _pairs(flag: str, text: str, rest: str, kinds: Mapping[str, str]) -> list[tuple[str, str]]:
    """Split what follows a name into keys and values."""
    first = next(iter(kinds), None)
    takes_bare = first is not None and kinds[first] in NAMES
    if first is not None and takes_bare and Path(rest).is_file():
        return [(first, rest)]  # whatever signs its name holds
    pairs = []
    for number, item in enumerate(rest.split(",") if rest else []):
        key, equals, value = item.partition("=")
        if not equals and number == 0 and first is not None and takes_bare:
            key, value = first, item
        elif not (key and equals and value):
            raise OptionError(f"{flag} {text}: {item!r} is not KEY=VALUE; write name:key=value,...")
        pairs.append((key.strip().replace("-", "_"), value.strip()))
    return pairs


def _convert(what: str, text: str, kind: str) -> Any:
    """Value of a parameter of a given type."""
    rule = rule_for(kind)
    try:
        return rule.read(text)
    except (ValueError, KeyError):
        raise OptionError(f"{what}={text}: write {rule.noun}") from None
