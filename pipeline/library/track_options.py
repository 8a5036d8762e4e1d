"""What a track was solved with, as keywords."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.library.keywords import options_of
from pipeline.track import Header
from pipeline.track.agreement import FREE, FREE_GROUPS
from stages.flows import FLOWS
from stages.layouts import LAYOUTS


def solved_with(header: Header) -> Mapping[str, Any]:
    """Options that decide what frames become, with every default filled in.

    Args:
        header: The track's.
    """
    values = dict(_flat(header.job))
    values["cuts"] = header.options["cuts"]
    told = {"frames": str(header.frame_range)}
    for keyword, option in options_of("solve").items():
        decides = option.group not in FREE_GROUPS and option.dest not in FREE
        if decides and option.dest in values:
            told[keyword] = _plain(values[option.dest])
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


def _plain(value: Any) -> Any:
    """A value as it is given."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return _spec(value)
    if isinstance(value, tuple):
        return [_plain(entry) for entry in value]
    return str(value) if isinstance(value, Path) else value


def _spec(member: Any) -> str:
    """A member of a registry as `name:key=value,...`; a picture that it holds is left out."""
    names = {cls: name for registry in (FLOWS, LAYOUTS) for name, cls in registry.items()}
    pairs = [
        f"{field.name}={getattr(member, field.name)}"
        for field in dataclasses.fields(member)
        if getattr(member, field.name) is not None
        and not isinstance(getattr(member, field.name), np.ndarray)
    ]
    return ":".join(filter(None, (names[type(member)], ",".join(pairs))))
