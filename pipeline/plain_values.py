"""Dataclasses as plain values for JSON, field by field, and back.

A new option is carried along without a change here: its type and, for a member of a registry,
the registry that its field names decide how it is read. Nothing that a file says is imported,
called or unpickled: classes come from the annotations and registries of the program itself.
"""

import base64
import dataclasses
import importlib
import types
import typing
import zlib
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

CLASS = "class"
"""Key under which a dataclass's name is kept."""


def to_plain(value: Any) -> Any:
    """Plain values that stand for a value.

    Args:
        value: A dataclass, an array, a tuple, a path, a fraction or something plain.
    """
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        inside = {f.name: to_plain(getattr(value, f.name)) for f in _fields(type(value))}
        return {CLASS: type(value).__name__, **inside}
    if isinstance(value, np.ndarray):
        packed = base64.b64encode(zlib.compress(np.ascontiguousarray(value).tobytes()))
        return {"dtype": value.dtype.str, "shape": list(value.shape), "data": packed.decode()}
    if isinstance(value, tuple | list):
        return [to_plain(entry) for entry in value]
    return str(value) if isinstance(value, Path | Fraction) else value


def from_plain(cls: type, plain: Mapping[str, Any]) -> Any:
    """Make a dataclass from what `to_plain` made of it.

    Fields that are missing take their defaults, keys that are unknown are left out: an option
    may have come or gone since.

    Args:
        cls: The dataclass.
        plain: Its plain values.

    Raises:
        ValueError, TypeError or KeyError: If the values are of other kinds.
    """
    hints = typing.get_type_hints(cls)
    values = {
        field.name: _value(hints[field.name], plain[field.name], field.metadata.get("registry"))
        for field in _fields(cls)
        if field.name in plain
    }
    return cls(**values)


def _fields(cls: Any) -> list[dataclasses.Field[Any]]:
    return [field for field in dataclasses.fields(cls) if field.init]


def _value(hint: Any, plain: Any, registry: str | None) -> Any:
    """A value of an annotated type."""
    if plain is None:
        return None
    if isinstance(hint, types.UnionType):
        hint = next(part for part in typing.get_args(hint) if part is not types.NoneType)
    if typing.get_origin(hint) is tuple:
        kinds = typing.get_args(hint)
        return tuple(_value(kinds[0], entry, registry) for entry in plain)
    if registry is not None:
        return from_plain(_member(registry, plain[CLASS]), plain)
    if dataclasses.is_dataclass(hint):
        return from_plain(hint, plain)  # type: ignore[arg-type]
    if hint is np.ndarray:
        content = zlib.decompress(base64.b64decode(plain["data"]))
        return np.frombuffer(content, dtype=plain["dtype"]).reshape(plain["shape"])
    return hint(plain) if hint in (Path, Fraction, float, int) else plain


def _member(registry: str, name: str) -> type:
    """The class of a registry that has a name."""
    module, _, table = registry.partition(":")
    members = getattr(importlib.import_module(module), table).values()
    return next(member for member in members if member.__name__ == name)
