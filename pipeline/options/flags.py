"""Values of flags: from the text that a user wrote to a number, a size or a text."""

import math
from argparse import ArgumentTypeError
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from pipeline.options.output_size import FORM, parse_size


def whole_number(text: str) -> int:
    """Read a whole number.

    Raises:
        ArgumentTypeError: If it is none.
    """
    try:
        return int(text)
    except ValueError:
        raise ArgumentTypeError(f"{text!r} is not a whole number; write one such as 12") from None


def real_number(text: str) -> float:
    """Read a finite number.

    Raises:
        ArgumentTypeError: If it is none.
    """
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ArgumentTypeError(f"{text!r} is not a number; write one such as 0.5")
    return number


def rate(text: str) -> Fraction:
    """Read a number of frames a second, such as 24, 29.97 or 30000/1001.

    Raises:
        ArgumentTypeError: If the text has another form.
    """
    try:
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise ArgumentTypeError(
            f"{text!r} is not a rate; write one such as 24 or 30000/1001"
        ) from None


def size(text: str) -> tuple[int, int]:
    """Read a width and a height, such as 1280x720; see `parse_size`.

    Raises:
        ArgumentTypeError: If the text has another form.
    """
    try:
        return parse_size(text)
    except ValueError:
        raise ArgumentTypeError(f"{text!r} is not a size; write {FORM}") from None


def text_value(text: str) -> str:
    """Take a text that is not empty.

    Raises:
        ArgumentTypeError: If it is empty.
    """
    if not text:
        raise ArgumentTypeError("is empty; give a value or leave the option out")
    return text


_READERS: dict[str, Callable[[str], Any]] = {
    "int": whole_number,
    "float": real_number,
    "Fraction": rate,
    "tuple[int, int]": size,
}


def reader_for(kind: str) -> Callable[[str], Any]:
    """The function that reads values of a type; text is taken as it is.

    Args:
        kind: The type as a dataclass declares it, such as `int | None`.
    """
    return _READERS.get(kind.removesuffix(" | None"), text_value)
