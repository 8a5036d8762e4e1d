"""Dataclasses as plain values for JSON, field by field, and back.

A new option is carried along without a change here: its type and, for a member of a registry,
the registry of its field decide how it is read. A member is stored under its name in the registry.
Nothing that a file says is imported, called or unpickled: classes come from the annotations and
registries of the program itself, every value is of the annotated type, and an array is not unpacked
beyond the shape that it declares.
"""

import base64
import dataclasses
import math
import re
import reprlib
import types
import typing
import zlib
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.track.nouns import noun_of
from warp_kernels.errors import OptionError
from warp_kernels.registry import Registry

CLASS = "class"
"""Key under which a dataclass's name is kept, or a member's in its registry."""
GONE: frozenset[str] = frozenset()
"""Fields that earlier versions wrote and this one does not know any more: they are passed over."""
MOST_BYTES = 1 << 30
"""Largest array [bytes]: a grey picture of as many pixels as any source may have."""
_FRACTION = re.compile(r"-?\d{1,30}(/\d{1,30})?")


class UnknownNameError(ValueError):
    """A class or a field that this program does not have: another version wrote it."""


def to_plain(value: Any, registry: Registry[Any] | None = None) -> Any:
    """Plain values that stand for a value.

    Args:
        value: A dataclass, an array, a tuple, a path, a fraction or something plain.
        registry: The registry of which it is a member, or of which all in a tuple are.
    """
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        cls = type(value)
        inside = {
            f.name: to_plain(getattr(value, f.name), f.metadata.get("registry"))
            for f in _fields(cls)
        }
        return {CLASS: cls.__name__ if registry is None else registry.name_of(cls), **inside}
    if isinstance(value, np.ndarray):
        packed = base64.b64encode(zlib.compress(np.ascontiguousarray(value).tobytes()))
        return {"dtype": value.dtype.str, "shape": list(value.shape), "data": packed.decode()}
    if isinstance(value, tuple | list):
        return [to_plain(entry, registry) for entry in value]
    return str(value) if isinstance(value, Path | Fraction) else value


def from_plain(cls: type, plain: Any, *, arrays: bool = True) -> Any:
    """Make a dataclass from what `to_plain` made of it.

    Fields that are missing take their defaults: an option may have come since.

    Args:
        cls: The dataclass.
        plain: Its plain values.
        arrays: Whether arrays are unpacked; else they are checked and become None.

    Raises:
        UnknownNameError: If a class or a field is not one of this program.
        ValueError: If a value is of another kind than its field, or one without a default is
            missing.
    """
    if not isinstance(plain, Mapping):
        raise ValueError(f"{cls.__name__}: {reprlib.repr(plain)} stands for no such thing")
    if plain.get(CLASS, cls.__name__) != cls.__name__:
        raise UnknownNameError(f"the class {reprlib.repr(plain[CLASS])} for {cls.__name__}")
    fields = {field.name: field for field in _fields(cls)}
    for name in plain:
        if name not in fields and name != CLASS and name not in GONE:
            raise UnknownNameError(f"the field {reprlib.repr(name)} of {cls.__name__}")
    hints = typing.get_type_hints(cls, None, {"np": np})  # which light modules do not import
    values = {}
    for name in (name for name in fields if name in plain):
        registry = fields[name].metadata.get("registry")
        try:
            values[name] = _value(hints[name], plain[name], registry, arrays)
        except UnknownNameError:
            raise
        except (ValueError, OverflowError, ZeroDivisionError) as error:
            raise ValueError(f"{name}: {error}") from error
    lacking = [name for name, field in fields.items() if name not in values and _is_wanted(field)]
    if lacking:
        raise ValueError(f"{cls.__name__} lacks {', '.join(lacking)}")
    return cls(**values)


def _is_wanted(field: dataclasses.Field[Any]) -> bool:
    missing = dataclasses.MISSING
    return field.default is missing and field.default_factory is missing


def _fields(cls: Any) -> list[dataclasses.Field[Any]]:
    return [field for field in dataclasses.fields(cls) if field.init]


def _value(hint: Any, plain: Any, registry: Registry[Any] | None, arrays: bool) -> Any:
    """A value of an annotated type."""
    if isinstance(hint, types.UnionType):
        if plain is None:
            return None
        hint = next(part for part in typing.get_args(hint) if part is not types.NoneType)
    if typing.get_origin(hint) is tuple:
        return _several(typing.get_args(hint), plain, registry, arrays)
    if registry is not None:
        return _member(registry, plain, arrays)
    if dataclasses.is_dataclass(hint):
        return from_plain(hint, plain, arrays=arrays)  # type: ignore[arg-type]
    if hint is np.ndarray:
        return _array(plain, unpacked=arrays)
    return _single(hint, plain)


def _several(
    kinds: tuple[Any, ...], plain: Any, registry: Registry[Any] | None, arrays: bool
) -> Any:
    """A tuple: of any length if its kinds end in an ellipsis."""
    is_open = kinds[-1] is Ellipsis
    if not isinstance(plain, list) or not (is_open or len(plain) == len(kinds)):
        raise ValueError(f"{reprlib.repr(plain)} is not such a list")
    each = kinds[:1] * len(plain) if is_open else kinds
    found = zip(each, plain, strict=True)
    return tuple(_value(kind, entry, registry, arrays) for kind, entry in found)


def _single(hint: Any, plain: Any) -> Any:
    """A truth, a number, a text, a path or a fraction; JSON tells truths from numbers."""
    written: Any = {bool: bool, int: int, float: (int, float)}.get(hint, str)
    if not isinstance(plain, written) or (isinstance(plain, bool) and hint is not bool):
        raise ValueError(f"{reprlib.repr(plain)} instead of {noun_of(hint)}")
    if hint is float and not math.isfinite(plain):
        raise ValueError(f"{plain} is no number")
    if isinstance(plain, str) and "\0" in plain:
        raise ValueError(f"{reprlib.repr(plain)} holds a character of no text")
    if hint is Fraction and not _FRACTION.fullmatch(plain):
        raise ValueError(f"{reprlib.repr(plain)} is no fraction")
    return hint(plain)


def _array(plain: Any, *, unpacked: bool) -> np.ndarray | None:
    """An array of numbers, no larger than its shape allows."""
    if not isinstance(plain, Mapping) or plain.keys() != {"dtype", "shape", "data"}:
        raise ValueError(f"{reprlib.repr(plain)} is no array")
    kind, shape, data = plain["dtype"], plain["shape"], plain["data"]
    if not isinstance(kind, str) or not re.fullmatch(r"[<>|]?[fiub][1248]", kind):
        raise ValueError(f"an array of {reprlib.repr(kind)}")
    sides: list[Any] = shape if isinstance(shape, list) and len(shape) <= 4 else [None]
    if not all(type(side) is int and side >= 0 for side in sides):
        raise ValueError(f"an array of shape {reprlib.repr(shape)}")
    size = math.prod(sides) * np.dtype(kind).itemsize
    if size > MOST_BYTES or not isinstance(data, str):
        raise ValueError(f"an array of {size} bytes; {MOST_BYTES} are the most")
    if not unpacked:
        return None
    try:
        content = zlib.decompressobj().decompress(base64.b64decode(data), size + 1)
    except zlib.error as error:
        raise ValueError(str(error)) from error
    return np.frombuffer(content, dtype=kind).reshape(sides)


def _member(registry: Registry[Any], plain: Any, arrays: bool) -> Any:
    """The member of a registry that plain values name."""
    if not isinstance(plain, Mapping):
        raise ValueError(f"{reprlib.repr(plain)} stands for no such thing")
    name = plain.get(CLASS)
    try:
        cls = registry[name] if isinstance(name, str) and name in registry else None
    except OptionError as error:  # of a package that does not work here
        raise UnknownNameError(str(error)) from error
    if cls is None:
        raise UnknownNameError(f"the member {reprlib.repr(name)} of {registry}")
    return from_plain(cls, {k: v for k, v in plain.items() if k != CLASS}, arrays=arrays)
