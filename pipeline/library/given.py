"""From the keywords of a call to values by field name, as the command line gives them."""

import difflib
import os
from collections.abc import Mapping
from typing import Any

from pipeline.library.keywords import PRESET, TAKEN, options_of
from pipeline.options.command_line import Option, with_preset
from pipeline.options.written import in_program
from warp_kernels.errors import OptionError

INSTEAD = {
    "quiet": "calls are, unless progress says otherwise",
    "verbose": "notes are in the result",
    "allow_url": "urllib.request.urlretrieve fetches a file",
    "debug": "Python shows where an error arose",
}
"""What is there in place of flags that make no sense in a program."""


def given_values(function: str, keywords: Mapping[str, Any]) -> dict[str, object]:
    """Check keywords and give what a job is built from; None is as if left out.

    Args:
        function: Name of the function that was called.
        keywords: Its keywords.

    Raises:
        OptionError: If there is no such option, or a value is of the wrong kind.
    """
    options = options_of(function)
    values: dict[str, object] = {}
    preset: dict[str, object] = {}
    for name, value in keywords.items():
        if name == "preset" and function in PRESET:
            preset = _preset(value)
        elif name not in options:
            raise OptionError(_unknown(function, name))
        elif value is not None:
            option = options[name]
            if option.dest == "edits" and not isinstance(value, str | os.PathLike):
                values[option.dest] = _log(value)
                continue
            plain = _plain(value, is_size=option.dest == "output_size")
            values[option.dest] = _read(option, name, plain)
    return with_preset(values, preset)


def _log(value: Any) -> object:
    """A log of edits that is no file: edits, or what a line of a file says."""
    from pipeline.edit_log.json_lines import log_of

    return log_of(value)


def _read(option: Option, name: str, value: object) -> object:
    """The value of an option, as the command line gives it."""
    if option.is_switch:  # a keyword is the field itself, also where the flag says no
        if not isinstance(value, bool):
            other = ""
            if name == "audio" and isinstance(value, str):
                other = f", or audio_mode={value!r} for a file, copy or aac"
            raise OptionError(f"{name}={value!r}: give True or False{other}")
        return value
    return option.value(value, name, in_program)


def file_name(what: str, value: object) -> str:
    """The name of a file.

    Args:
        what: The parameter, for messages.
        value: A text or a path.

    Raises:
        OptionError: If it is none, or empty.
    """
    if not isinstance(value, str | os.PathLike):
        raise OptionError(f"{what}: {_kind(value)} is no name of a file; give a text or a path")
    name = os.fspath(value)
    if not isinstance(name, str) or not name:
        raise OptionError(f"{what}={name!r}: give the name of a file, as text")
    return name


def _preset(value: object) -> dict[str, object]:
    """Values of a preset."""
    from pipeline.options.presets import read_preset

    return {} if value is None else read_preset(file_name("preset", value))


def _plain(value: Any, *, is_size: bool = False) -> Any:
    """A value as a file of options could hold it."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, list | tuple):
        entries = [_plain(entry) for entry in value]
        if is_size and len(entries) == 2 and all(map(_is_whole, entries)):
            return f"{entries[0]}x{entries[1]}"
        return entries
    if type(value).__module__ == "numpy" and getattr(value, "ndim", None) == 0:
        return value.item()
    return value


def _is_whole(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _kind(value: object) -> str:
    """What a value is, for messages."""
    kind = type(value).__name__
    return "an array" if kind == "ndarray" else f"{value!r} ({kind})"


def _unknown(function: str, name: str) -> str:
    """What to say about a keyword that a function does not have."""
    drawn = next((n for n in (name, f"{name}s") if n in options_of("draw")), None)
    if drawn is not None and function in ("triangulate", "Animator"):
        return f"{name}: {function} draws nothing; give {drawn} to .draw() of what it returns"
    others = [other for other in TAKEN if name in options_of(other)]
    if others:
        owners = ", ".join(others)
        return f"{name}: {function} has no such option, only {owners}; leave it out"
    if name in INSTEAD:
        return f"{name}: {function} has no such option; {INSTEAD[name]}, so leave it out"
    known = [*options_of(function), *(["preset"] if function in PRESET else [])]
    begun = [keyword for keyword in known if keyword.startswith(name)]
    similar = begun or difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    hint = f"did you mean {similar[0]}?" if similar else f"there are {', '.join(known)}"
    return f"{name}: {function} has no such option; {hint}"
