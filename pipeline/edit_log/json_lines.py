"""Logs of edits as files: one edit a line, as JSON, such as

{"edit": "flip_edge", "frame": 60, "at": [313.5, 120.25]}
"""

import dataclasses
import json
import reprlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pipeline.options.edit_log import EditLog
from pipeline.options.members import parameters
from pipeline.options.nearest import nearest
from pipeline.track.plain_values import CLASS, UnknownNameError, from_plain, to_plain
from stages.hand import EDITS, Edit
from stages.media.text_file import read_text, reason_of
from stages.media.writing.commit import write_file
from warp_kernels.errors import MediaError, OptionError

HOLDERS = "give a file of edits, one a line as JSON, or a track that holds them"
"""What to say to whoever named another file."""
KIND = "edit"
"""The key of an edit's kind."""
MOST_EDITS = 100_000
"""Most lines of a log."""
MOST_CORNERS = 10_000
"""Most values of a line, so that a region has fewer corners."""
FORM = 'write one edit a line, such as {"edit": "flip_edge", "frame": 60, "at": [313.5, 120]}'
"""What to say to whoever wrote something else."""


def as_json_lines(log: EditLog) -> str:
    """A log as text, which `from_json_lines` reads; what is as it is by default is left out.

    Args:
        log: The log.
    """
    return "".join(f"{json.dumps(_as_dict(edit))}\n" for edit in log.edits)


def from_json_lines(text: str, name: str | Path) -> EditLog:
    """Read a log.

    Args:
        text: One edit a line; empty lines, and those that begin with #, say nothing.
        name: Where it is from, for messages.

    Raises:
        MediaError: Naming the line, what is wrong with it and what to do.
    """
    edits: list[Edit] = []
    for number, line in enumerate(text.splitlines(), start=1):
        if line.strip() and not line.lstrip().startswith("#"):
            try:
                edits.append(_edit(line))
            except _LineError as error:
                raise MediaError(name, f"line {number}: {error.problem}", error.remedy) from error
        if len(edits) > MOST_EDITS:
            raise MediaError(
                name, f"line {number}: more than {MOST_EDITS} edits", "leave some of them out"
            )
    return EditLog(tuple(edits))


def read_lines(path: Path) -> EditLog:
    """Read a log from a file.

    Raises:
        MediaError: If it cannot be read, or holds something else.
    """
    try:
        text = read_text(path)
    except (OSError, ValueError) as error:
        remedy = "check the name" if isinstance(error, OSError) else HOLDERS
        problem = f"the log of edits cannot be read ({reason_of(error)})"
        raise MediaError(path, problem, remedy) from error
    return from_json_lines(text, path)


def log_of(edits: object) -> EditLog:
    """A log from what a program has: edits, or mappings such as a line of a file holds.

    Args:
        edits: A log, or a sequence.

    Raises:
        OptionError: If it is something else.
        MediaError: Naming the entry that is no edit, counted from 1.
    """
    if isinstance(edits, EditLog):
        return edits
    if not isinstance(edits, Sequence) or isinstance(edits, str | bytes):
        raise OptionError(f"edits: {reprlib.repr(edits)} is no list; {FORM}")
    kinds = tuple(EDITS.usable.values())
    lines = [
        json.dumps(_as_dict(edit) if isinstance(edit, kinds) else edit, default=repr)
        for edit in edits
    ]
    return from_json_lines("\n".join(lines), "edits")


def write_log(log: EditLog, path: Path) -> None:
    """Write a log; the file appears when it is complete.

    Raises:
        OutputError: If it cannot be written.
    """
    write_file(path, as_json_lines(log).encode())


class _LineError(ValueError):
    """What is wrong with a line, and what to do about it."""

    def __init__(self, problem: str, remedy: str) -> None:
        super().__init__(problem)
        self.problem, self.remedy = problem, remedy


def _as_dict(edit: Edit) -> dict[str, Any]:
    """An edit as plain values."""
    values = to_plain(edit, EDITS)
    usual = {f.name: f.default for f in dataclasses.fields(edit)}  # type: ignore[arg-type]
    name = values.pop(CLASS)
    given = {key: v for key, v in values.items() if getattr(edit, key) != usual[key]}
    return {KIND: name, **given}


def _edit(line: str) -> Edit:
    """The edit of a line."""
    if line.count(",") > MOST_CORNERS:
        raise _LineError(f"more than {MOST_CORNERS} values", "give a region fewer corners")
    try:
        found = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise _LineError(f"is not JSON ({error})", FORM) from error
    if not isinstance(found, dict):
        raise _LineError(f"{reprlib.repr(found)} is not an edit", FORM)
    name = found.pop(KIND, None)
    if name is None:
        raise _LineError(f'it has no "{KIND}"', FORM)
    if not isinstance(name, str) or name not in EDITS:
        raise _LineError(f"no edit is called {reprlib.repr(name)}", nearest(str(name), EDITS))
    cls: Any = EDITS[name]
    known = [field.name for field in parameters(cls)]
    if CLASS in found:
        raise _LineError(f"{name} has no {CLASS!r}", f"it has {', '.join(known)}")
    needed = [f.name for f in parameters(cls) if f.default is dataclasses.MISSING]
    missing = [key for key in needed if key not in found]
    if missing:
        raise _LineError(f"{name} has no {missing[0]}", f"it needs {', '.join(needed)}")
    try:
        edit: Edit = from_plain(cls, found)
    except UnknownNameError as error:
        unknown = next(key for key in found if key not in known)
        raise _LineError(
            f"{name} has no {reprlib.repr(unknown)}", f"it has {', '.join(known)}"
        ) from error
    except ValueError as error:
        raise _LineError(f"{name}: {error}", "see docs/editing.md for its values") from error
    if not 0 <= edit.frame < 1 << 53:
        raise _LineError(f"frame {edit.frame} is none", "frames count from 0")
    return edit
