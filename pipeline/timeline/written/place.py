"""Where something stands in a file, for messages."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from warp_kernels.errors import OptionError

Table = tuple[str | int, ...]
"""A table of a file: `()` for its beginning, `("curves",)`, `("section", 2, "curves")`."""

_HEADER = re.compile(r"\s*(\[\[?)\s*([^\]]+?)\s*\]\]?\s*(?:#.*)?$")
_ENTRY = re.compile(r"""\s*((?:"[^"]*"|'[^']*'|[\w.\-\[\] ])+?)\s*=\s*""")


@dataclass(frozen=True)
class Place:
    """A place in a file."""

    file: str
    """The name, as the user gave it."""
    line: int = 1
    """Counted from 1."""
    column: int | None = None
    """Counted from 1; None for the whole line."""

    def __str__(self) -> str:
        column = "" if self.column is None else f":{self.column}"
        return f"{self.file}:{self.line}{column}"

    def error(self, problem: object) -> OptionError:
        """What is raised about something that is wrong here.

        Args:
            problem: What is wrong, the value and the remedy.
        """
        return OptionError(f"{self}: {' '.join(str(problem).split())}")

    def after(self, characters: int) -> "Place":
        """A place further on in the line, if the column is known.

        Args:
            characters: How far.
        """
        if self.column is None:
            return self
        return replace(self, column=self.column + characters)


@dataclass(frozen=True)
class Places:
    """Where the entries of a file stand."""

    file: str
    """The name, as the user gave it."""
    entries: Mapping[tuple[Table, str], Place]
    """The values, by table and key."""
    headers: Mapping[Table, Place]
    """The headers of tables."""
    lines: tuple[str, ...]
    """The lines of the file."""

    def of(self, table: Table, key: str | None = None) -> Place:
        """Where a value stands, or a table, or the file if that cannot be told.

        Args:
            table: The table.
            key: The key in it; None for the table's header.
        """
        here = self.headers.get(table, Place(self.file))
        return here if key is None else self.entries.get((table, key), here)

    def of_text(self, table: Table, key: str, text: str) -> Place:
        """Where a text stands in a value of several lines.

        Args:
            table: The table.
            key: The key in it.
            text: A part of the value.
        """
        start = self.of(table, key)
        for number in range(start.line, len(self.lines) + 1):
            found = self.lines[number - 1].find(text)
            if found >= 0:
                return Place(self.file, number, found + 1)
        return start


@dataclass(frozen=True)
class Doubled:
    """Something that a file says twice."""

    name: str
    """The key, or the table in brackets."""
    first: Place
    """Where it stands first."""
    place: Place
    """Where it stands again."""


def doubled_in(text: str, file: str, last: int) -> Doubled | None:
    """The last key or table that a file gives twice, up to a line.

    Args:
        text: The file.
        file: Its name.
        last: The line, from 1.
    """
    seen: dict[tuple[Table, str | None], Place] = {}
    found = None
    counts: dict[str, int] = {}
    table: Table = ()
    for number, line in enumerate(text.split("\n")[:last], start=1):
        header, entry = _HEADER.match(line), _ENTRY.match(line)
        key, column = None, None
        if header is not None:
            table = _table_of(header[1], header[2], counts)
            name = f"[{header[2]}]"
        elif entry is not None:
            name = key = _plain_key(entry[1])
            column = entry.start(1) + 1
        else:
            continue
        place = Place(file, number, column)
        if (table, key) in seen:
            found = Doubled(name, seen[table, key], place)
        seen.setdefault((table, key), place)
    return found


def places_of(text: str, file: str) -> Places:
    """Find out where the entries of a TOML file stand, which its parser does not tell.

    Args:
        text: The file.
        file: Its name.
    """
    entries: dict[tuple[Table, str], Place] = {}
    headers: dict[Table, Place] = {}
    counts: dict[str, int] = {}
    table: Table = ()
    lines = tuple(text.split("\n"))  # as TOML counts them: other separators may stand in texts
    for number, line in enumerate(lines, start=1):
        header = _HEADER.match(line)
        if header is not None:
            table = _table_of(header[1], header[2], counts)
            headers.setdefault(table, Place(file, number))
            continue
        entry = _ENTRY.match(line)
        if entry is not None:
            opening = len(line[entry.end() :]) > 0 and line[entry.end()] in "\"'"
            place = Place(file, number, entry.end() + 1 + opening)
            entries.setdefault((table, _plain_key(entry[1])), place)
    return Places(file, entries, headers, lines)


def _table_of(brackets: str, name: str, counts: dict[str, int]) -> Table:
    """The table that a header begins; those of a list are counted."""
    parts = [_plain_key(part) for part in name.split(".")]
    if brackets == "[[":
        counts[parts[0]] = counts.get(parts[0], -1) + 1
        return parts[0], counts[parts[0]]
    if parts[0] in counts:
        return parts[0], counts[parts[0]], *parts[1:]
    return tuple(parts)


def _plain_key(written: str) -> str:
    return re.sub(r"[\"']", "", written).replace(" ", "")
