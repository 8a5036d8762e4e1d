"""What a track was solved with, as keywords."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.library.keywords import options_of
from pipeline.track import Header
from pipeline.track.agreement import FREE
from warp_kernels.registry import Registry


def solved_with(header: Header) -> Mapping[str, Any]:
    """Options that decide what frames become, with every default filled in.

    Args:
        header: The track's.
    """
    values = dict(_flat(header.solve))
    values["cuts"] = header.options["cuts"]
    told = {"frames": str(header.frame_range)}
    for keyword, option in options_of("solve").items():
        if option.dest in values and option.dest not in FREE:
            told[keyword] = _plain(values[option.dest], option.registry)
    return told


def _flat(options: Any) -> Mapping[str, Any]:
    """Fields of a dataclass of options and of those inside it, by name."""
    found: dict[str, Any] = {}
    for field in dataclasses.fields(options):
        value = getattr(options, field.name)
        if dataclasses.is_dataclass(value) and "help" not in field.metadata:
            found = {**_flat(value), **found}
        else:
            found[field.name] = value
    return found


def _plain(value: Any, registry: Registry[Any] | None) -> Any:
    """A value as it is given.

    Args:
        value: What the options hold.
        registry: The registry whose members it names, or None.
    """
    if isinstance(value, tuple):
        return [_plain(entry, registry) for entry in value]
    if registry is not None and dataclasses.is_dataclass(value):
        return _spec(value, registry)
    return str(value) if isinstance(value, Path) else value


def _spec(member: Any, registry: Registry[Any]) -> str:
    """A member of a registry as `name:key=value,...`; a picture that it holds is left out."""
    values = {field.name: getattr(member, field.name) for field in dataclasses.fields(member)}
    pairs = [
        f"{key}={value}"
        for key, value in values.items()
        if value is not None and not isinstance(value, np.ndarray)
    ]
    return ":".join(filter(None, (registry.name_of(type(member)), ",".join(pairs))))
