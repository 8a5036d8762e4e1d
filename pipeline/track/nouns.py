"""What kinds of values are called in messages to people."""

from fractions import Fraction
from pathlib import Path
from types import NoneType
from typing import Any

NOUNS: dict[type, str] = {
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    str: "a text",
    Path: "a name of a file",
    Fraction: "a fraction",
    bytes: "bytes",
    list: "a list",
    dict: "a table",
    NoneType: "nothing",
}
"""By type."""


def noun_of(kind: type) -> str:
    """What values of a type are called."""
    return NOUNS.get(kind, kind.__name__)


def noun_for(value: Any) -> str:
    """What a value is."""
    return noun_of(type(value))
