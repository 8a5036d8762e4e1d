"""Options as words of a command line: what was given here, for a program that runs elsewhere."""

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from pipeline.options.command_line import Option

_FILE = re.compile(r"FILE|MAP|LOG")
"""In the metavar of an option: a name of a file may stand there."""


def as_words(given: Mapping[str, Any], options: Iterable[Option]) -> list[str]:
    """Options as `--flag=value`; names of files that are there become absolute.

    Args:
        given: Values by field name; those that were not given are absent.
        options: Those that are wanted.
    """
    return [
        word
        for option in options
        if given.get(option.dest) is not None
        for word in _words(option, given[option.dest])
    ]


def absolute(name: str) -> str:
    """The absolute name of a file that is there, or the same text.

    Args:
        name: Perhaps a name, or a pattern of numbered stills.
    """
    folder = os.path.dirname(name) or os.curdir
    is_file = os.path.exists(name) or ("#" in name and os.path.isdir(folder))
    return os.path.abspath(name) if is_file else name


def _words(option: Option, value: Any) -> Iterator[str]:
    if option.is_switch:
        if value != option.default:
            yield f"--{option.flag}"
        return
    for entry in value if option.is_repeatable else [value]:
        yield f"--{option.flag}={_located(option, str(entry))}"


def _located(option: Option, text: str) -> str:
    """A value in which names of files are absolute."""
    if option.registry is not None:
        name, colon, values = text.partition(":")
        return name + colon + ",".join(map(_located_entry, values.split(",")))
    if text in option.metavar.split("|") or not _FILE.search(option.metavar):
        return text
    return absolute(text)


def _located_entry(text: str) -> str:
    """One of the values of a member: `KEY=VALUE`, or a value alone."""
    key, equals, value = text.rpartition("=")
    return key + equals + absolute(value) if value else text
