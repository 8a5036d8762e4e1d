"""Values from text: one set of rules for command lines, presets, programs and parameters."""

import math
import re
import reprlib
from argparse import ArgumentTypeError
from collections.abc import Callable
from dataclasses import Field
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple, get_origin

from pipeline.options.output_size import FORM, parse_size
from warp_kernels.errors import OptionError

_SWITCHES = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}


def kind_of(field: Field[Any]) -> str:
    """The type of a field as it is written, such as `int | None`."""
    kind: Any = field.type
    if isinstance(kind, type) and get_origin(kind) is None:
        return kind.__name__
    return re.sub(r"\w+\.", "", str(kind))


def _finite(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(text)
    return number


def _picture(name: str) -> Any:
    from stages.masks.gray import read_gray

    return read_gray(name)


class _Rule(NamedTuple):
    """How values of a type are read."""

    read: Callable[[str], Any]
    noun: str = ""
    example: str = ""


_RULES = {
    "bool": _Rule(lambda text: _SWITCHES[text.lower()], "true or false", "true or false"),
    "int": _Rule(int, "a whole number", "one such as 12"),
    "float": _Rule(_finite, "a number", "one such as 0.5"),
    "Fraction": _Rule(Fraction, "a rate", "one such as 24 or 30000/1001"),
    "tuple[int, int]": _Rule(parse_size, "a size", FORM),
    "Path": _Rule(Path),
    "ndarray": _Rule(_picture),
}
_TEXT = _Rule(str)
NAMES = frozenset({"str", "Path", "ndarray"})
"""Types whose values are texts, or names of files."""


def rule_for(kind: str) -> _Rule:
    """How values of a type are read; `read` raises ValueError, KeyError or ZeroDivisionError.

    Args:
        kind: See `kind_of`.
    """
    return _RULES.get(kind.removesuffix(" | None"), _TEXT)


def reader_for(kind: str) -> Callable[[str], Any]:
    """The function that reads values of a type; it raises ArgumentTypeError.

    Args:
        kind: See `kind_of`.
    """
    rule = rule_for(kind)

    def read(text: str) -> Any:
        """Read a value."""
        if not text and not rule.noun:
            raise ArgumentTypeError("is empty; give a value or leave the option out")
        try:
            return rule.read(text)
        except (ValueError, KeyError, ZeroDivisionError):
            raise ArgumentTypeError(f"{text!r} is not {rule.noun}; write {rule.example}") from None

    return read


whole_number, text_value, size = (reader_for(kind) for kind in ("int", "str", "tuple[int, int]"))


def plain_value(kind: str, value: object, what: str, sign: str, metavar: str | None) -> Any:
    """The value that the command line would give for one of a file or a program.

    Args:
        kind: See `kind_of`.
        value: A number or a text.
        what: Where it stands, for messages.
        sign: What stands between that and the value in messages.
        metavar: How it is written.

    Raises:
        OptionError: If the value is of another kind.
    """
    if isinstance(value, bool) or not isinstance(value, str | int | float | Fraction):
        shown = " ".join(reprlib.repr(value).split())
        form = f", as {metavar}" if metavar else ""
        raise OptionError(f"{what}{sign}{shown}: write a number or a text in quotes{form}")
    try:
        return reader_for(kind)(str(value))
    except ArgumentTypeError as error:
        raise OptionError(f"{what}: {error}") from error
