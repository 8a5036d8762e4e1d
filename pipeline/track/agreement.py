"""Which options two tracks do not share, of those that decide what a frame becomes."""

from collections.abc import Iterator, Mapping
from typing import Any

from pipeline.options.command_line import Option, job_options
from pipeline.options.declared import registry_classes
from pipeline.track.plain_values import CLASS

FREE = frozenset({"source", "frame_range"})
"""Fields that may differ: the source is compared by its content, the range by what it joins."""


def differing_flags(mine: Mapping[str, Any], theirs: Mapping[str, Any]) -> list[str]:
    """The options that differ, such as `--triangles 90 instead of 120`.

    Args:
        mine: `SolveOptions` as plain values: what is right.
        theirs: Another's.
    """
    options = {option.dest: option for option in job_options()}
    kept = [{k: v for k, v in job.items() if k not in FREE} for job in (mine, theirs)]
    return list(_differing(kept[0], kept[1], options))


def _differing(
    mine: Mapping[str, Any], theirs: Mapping[str, Any], options: Mapping[str, Option]
) -> Iterator[str]:
    for name in {**mine, **theirs}:
        one, other = mine.get(name), theirs.get(name)
        if one == other:
            continue
        option = options.get(name)
        if option is None and isinstance(one, Mapping) and isinstance(other, Mapping):
            yield from _differing(one, other, options)
        else:
            flag = f"--{option.flag}" if option is not None else name
            names = _names(option)
            yield f"{flag} {_shown(other, names)} instead of {_shown(one, names)}"


def _names(option: Option | None) -> dict[str, str]:
    """Names of the members of an option's registry, by the names of their classes."""
    registry = None if option is None else option.declared.metadata.get("registry")
    members = {} if registry is None else registry_classes(registry)
    return {cls: name for name, cls in members.items()}


def _shown(value: Any, names: Mapping[str, str]) -> str:
    """A value as short as a message needs it, as the command line takes it."""
    if isinstance(value, Mapping) and CLASS in value:
        pairs = (f"{key}={_shown(entry, {})}" for key, entry in value.items() if key != CLASS)
        name = str(value[CLASS])
        return ":".join(filter(None, (names.get(name, name.lower()), ",".join(pairs))))
    if isinstance(value, list) and names:
        return " ".join(_shown(entry, names) for entry in value) or "auto"
    if isinstance(value, Mapping):
        return "(a picture)"
    text = "none" if value is None else str(value)
    return text if len(text) <= 40 else f"{text[:37]}..."
