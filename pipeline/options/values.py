"""Values from text: one set of rules for command lines, presets, programs and parameters."""

import math
import re
from argparse import ArgumentTypeError
from collections.abc import Callable
from dataclasses import Field
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

from stages.look.output_size import FORM, parse_size
from warp_kernels.registry import imported

_SWITCHES = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}
_SECONDS = re.compile(r"(.+?) *(ms|s|sec|seconds?)?")


def _seconds(text: str) -> float:
    """Seconds of a number, with or without its unit."""
    match = _SECONDS.fullmatch(text.strip())
    if match is None:
        raise ValueError(text)
    return float(match[1]) / (1000.0 if match[2] == "ms" else 1.0)


_RULES: dict[str, tuple[Callable[[str], Any], str, str]] = {
    "bool": (lambda text: _SWITCHES[text.lower()], "true or false", "true or false"),
    "int": (int, "a whole number", "one such as 12"),
    "float": (float, "a number", "one such as 0.5"),
    "seconds": (_seconds, "a time", "seconds, such as 2, 0.5s or -250ms"),
    "Fraction": (Fraction, "a rate", "one such as 24 or 30000/1001"),
    "tuple[int, int]": (parse_size, "a size", FORM),
}
"""How values of a type are read, what they are, and how one is written."""
NAMES: dict[str, Callable[[str], Any]] = {
    "str": str,
    "Path": Path,
    "ndarray": lambda name: imported("stages.masks.gray:read_gray")(name),
    "points": lambda name: imported("stages.layouts.point_file:read_points")(name),
}
"""Types whose values are any text, among them names of files."""


def kind_of(field: Field[Any]) -> str:
    """The type of a field as it is written, such as `int`, but for its modules and None.

    Arrays that are not read as pictures, and numbers of seconds, say in their metadata what `reads`
    them.
    """
    if "reads" in field.metadata:
        return str(field.metadata["reads"])
    return re.sub(r"<class '|'>|\w+\.| \| None$", "", str(field.type))


def read_value(kind: str, text: str, parameter: str | None = None) -> Any:
    """Read a value of a type, see `kind_of`; the message names a parameter if it is one's.

    Raises:
        ArgumentTypeError: If the text stands for no such value.
        MediaError: If it names a picture that cannot be read.
    """
    if kind not in _RULES:
        if not text:
            raise ArgumentTypeError("is empty; give a value")
        return NAMES.get(kind, str)(text)
    read, noun, form = _RULES[kind]
    try:
        value = read(text)
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(text)
    except (ValueError, KeyError, ZeroDivisionError):
        if parameter:
            raise ArgumentTypeError(f"{parameter}={text}: write {noun}") from None
        raise ArgumentTypeError(f"{text!r} is not {noun}; write {form}") from None
    return value


text_value: Callable[[str], str] = partial(read_value, "str")
whole_number: Callable[[str], int] = partial(read_value, "int")
plain_number: Callable[[str], float] = partial(read_value, "float")
