"""Which options two tracks do not share, of those that decide what a frame becomes."""

from collections.abc import Iterator, Mapping
from typing import Any

from pipeline.options.command_line import Option, job_options
from pipeline.options.edit_log import EditLog
from pipeline.track.plain_values import CLASS

FREE = frozenset({"source", "frame_range", "limits", "decoder"})
"""Fields that may differ: the source is compared by its content, the range by what it joins, limits
change nothing of what they let through, and frames are the same whoever decodes them."""

NAMES = {
    "of_triangles": "triangles of the --timeline",
    "of_error": "error of the --timeline",
    "of_focus": "focus.strength of the --timeline",
}
"""What fields are called that are no options."""


def differing_flags(mine: Mapping[str, Any], theirs: Mapping[str, Any]) -> list[str]:
    """The options that differ, such as `--triangles 90 instead of 120`.

    Args:
        mine: `SolveOptions` as plain values: what is right.
        theirs: Another's.
    """
    options = {option.dest: option for option in job_options()}
    return list(_differing(mine, theirs, options))


def _differing(
    mine: Mapping[str, Any], theirs: Mapping[str, Any], options: Mapping[str, Option]
) -> Iterator[str]:
    for name in {**mine, **theirs}:
        one, other = mine.get(name), theirs.get(name)
        if one == other or name in FREE:
            continue
        option = options.get(name)
        if option is None and isinstance(one, Mapping) and isinstance(other, Mapping):
            yield from _differing(one, other, options)
        else:
            flag = f"--{option.flag}" if option is not None else NAMES.get(name, name)
            empty = "none" if name in NAMES else "auto"
            yield f"{flag} {_shown(other, empty)} instead of {_shown(one, empty)}"


def _shown(value: Any, empty: str = "auto") -> str:
    """A value as short as a message needs it, as the command line takes it."""
    if isinstance(value, Mapping) and value.get(CLASS) == EditLog.__name__:
        return f"({len(value['edits'])} edits)"
    if isinstance(value, Mapping) and CLASS in value:
        pairs = (f"{key}={_shown(entry)}" for key, entry in value.items() if key != CLASS)
        return ":".join(filter(None, (str(value[CLASS]), ",".join(pairs))))
    if value == [] or (isinstance(value, list) and isinstance(value[0], Mapping)):
        return " ".join(map(_shown, value)) or empty
    if isinstance(value, Mapping):
        return "(a picture)"
    text = "none" if value is None else str(value)
    return text if len(text) <= 40 else f"{text[:37]}..."
