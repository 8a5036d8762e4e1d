"""The edits that a person is at, in a track: what is undone stays, what is acknowledged is safe."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pipeline.edit_log.json_lines import MOST_EDITS, as_json_lines, from_json_lines
from pipeline.options.edit_log import EditLog
from pipeline.track.header import read_header
from pipeline.track.schema import has_table, need_table, open_existing, reading, writing
from stages.hand import Edit
from warp_kernels.errors import EditError, MediaError, TrackError

MOST_LETTERS = 1 << 20
"""Longest edit that is read: what a line with `MOST_CORNERS` values never is."""


@dataclass(frozen=True)
class KeptEdit:
    """An edit in a journal, in force or undone."""

    number: int
    """Its number, from 1, in the order in which edits were made."""
    follows: int
    """Number of the edit after which it was made, 0 if it was the first."""
    edit: Edit
    """The edit."""


class EditJournal:
    """The edits in a track; a context manager.

    Edits are only ever added. Each knows the edit that it follows, and a pointer says which one is
    the last in force: `undo` and `redo` move it, and an edit that is made after an `undo` begins a
    branch that the pointer follows. Whatever returned from a method is on the disk, and several
    processes may have one journal open: each sees at once what another did.

    A journal begins with the log with which the frames of the track were solved.

    Args:
        path: The track's file.

    Raises:
        TrackError: If it is no whole track of this program's format.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._connection = open_existing(path)
        try:
            with reading(path):
                # an edit that a person was told is kept outlives a power cut as well
                self._connection.execute("PRAGMA synchronous = FULL")
                solved = read_header(path, self._connection).solve.edits or EditLog()
        except BaseException:
            self._connection.close()
            raise
        self._first = {n: KeptEdit(n, n - 1, edit) for n, edit in enumerate(solved.edits, start=1)}
        self._read: dict[int, KeptEdit] = {}

    @property
    def number(self) -> int:
        """Number of the last edit in force, 0 if there is none.

        Raises:
            TrackError: If the track is damaged.
        """
        with reading(self.path):
            return self._here()

    @property
    def log(self) -> EditLog:
        """The edits in force, in their order.

        Raises:
            TrackError: If the track is damaged.
        """
        with reading(self.path):
            kept, number = self._kept(), self._here()
        edits = []
        while number:
            edits.append(kept[number].edit)
            number = kept[number].follows  # always less: no file can make this last for ever
        return EditLog(tuple(edits[::-1]))

    @property
    def history(self) -> tuple[KeptEdit, ...]:
        """All edits that were ever made, by their numbers.

        Raises:
            TrackError: If the track is damaged.
        """
        with reading(self.path):
            return tuple(self._kept().values())

    def since(self, number: int) -> tuple[Edit, ...] | None:
        """The edits in force that follow one, in their order; None if it is not in force.

        Args:
            number: Its number; 0 for all of them.

        Raises:
            TrackError: If the track is damaged.
        """
        with reading(self.path):
            kept, here = self._kept(), self._here()
        found = []
        while here > number:
            found.append(kept[here].edit)
            here = kept[here].follows
        return tuple(found[::-1]) if here == number else None

    def append(self, edits: Iterable[Edit], after: int | None = None) -> int:
        """Add edits after the last one in force: either all are kept or none is.

        Args:
            edits: The edits, in their order.
            after: Number of the edit that must be the last one in force: another window may have
                gone on. None for whichever it is.

        Returns:
            Number of the last edit in force now.

        Raises:
            EditError: If another edit is in force, or there are too many.
            OutputError: If they cannot be written.
            TrackError: If the track is damaged.
        """
        texts = as_json_lines(EditLog(tuple(edits))).splitlines()
        with self._changing() as here:
            if after not in (None, here):
                raise EditError(
                    f"edit {here} is the last one in force, not edit {after}: another window went "
                    "on; look at what it did, then make the edit again"
                )
            (most,) = self._connection.execute("SELECT MAX(number) FROM edits").fetchone()
            number = most or 0
            if number + len(texts) > MOST_EDITS:
                raise EditError(
                    f"{number + len(texts)} edits, a track keeps {MOST_EDITS}; solve to a new "
                    "track with --edits and go on there"
                )
            for text in texts:
                self._add(number := number + 1, here, text)
                here = number
        return here

    def undo(self) -> Edit | None:
        """Put the last edit out of force.

        Returns:
            The edit, or None if none is in force.

        Raises:
            OutputError: If that cannot be written.
            TrackError: If the track is damaged.
        """
        with self._changing() as here:
            if not here:
                return None
            undone = self._kept()[here]
            self._place(undone.follows)
        return undone.edit

    def redo(self) -> Edit | None:
        """Put that edit in force again that was so last, of those after the last one in force.

        Returns:
            The edit, or None if there is none.

        Raises:
            OutputError: If that cannot be written.
            TrackError: If the track is damaged.
        """
        with self._changing() as here:
            found = self._after(here)
            if found is None:
                return None
            self._place(found)
            return self._kept()[found].edit

    @property
    def can_redo(self) -> bool:
        """Whether an edit that was undone can be put in force again.

        Raises:
            TrackError: If the track is damaged.
        """
        with reading(self.path):
            return self._is_begun() and self._after(self._here()) is not None

    def go_to(self, number: int) -> None:
        """Make an edit the last one in force, on whichever branch it is.

        Args:
            number: Its number; 0 puts all out of force.

        Raises:
            EditError: If there is no such edit.
            OutputError: If that cannot be written.
            TrackError: If the track is damaged.
        """
        with self._changing() as here:
            if number and number not in self._kept():
                last = max(self._kept(), default=0)
                raise EditError(f"there is no edit {number!r}; numbers go from 0 to {last}")
            if number != here:
                self._place(number)

    @contextmanager
    def _changing(self) -> Iterator[int]:
        """One transaction that no other process gets between; gives the last edit in force."""
        with writing(self.path):
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                if not self._is_begun():
                    need_table(self._connection, "edits")
                    need_table(self._connection, "edit_places")
                    for kept in self._first.values():
                        text = as_json_lines(EditLog((kept.edit,))).strip()
                        self._add(kept.number, kept.follows, text)
                yield self._here()
                self._connection.execute("COMMIT")
            finally:
                if self._connection.in_transaction:
                    self._connection.execute("ROLLBACK")

    def _is_begun(self) -> bool:
        return has_table(self._connection, "edit_places")

    def _here(self) -> int:
        """The pointer."""
        if not self._is_begun():
            return len(self._first)
        newest = "SELECT number FROM edit_places ORDER BY step DESC LIMIT 1"
        (number,) = self._connection.execute(newest).fetchone() or (0,)
        if number != 0 and (type(number) is not int or number not in self._kept()):
            raise self._damaged(f"edit {number!r} is in force and is not there")
        return number

    def _after(self, here: int) -> int | None:
        """Which of the edits that follow one was in force last, or None."""
        found = self._connection.execute(
            "SELECT number FROM edit_places JOIN edits USING (number) WHERE follows = ?"
            " ORDER BY step DESC LIMIT 1",
            (here,),
        ).fetchone()
        return None if found is None else int(found[0])

    def _add(self, number: int, follows: int, text: str) -> None:
        """Write an edit, and let the pointer follow."""
        self._connection.execute("INSERT INTO edits VALUES (?, ?, ?)", (number, follows, text))
        self._place(number)

    def _place(self, number: int) -> None:
        self._connection.execute("INSERT INTO edit_places (number) VALUES (?)", (number,))

    def _kept(self) -> dict[int, KeptEdit]:
        """All edits; those that were read before are not read again, for none ever changes."""
        if not self._is_begun():
            return self._first
        rows = self._connection.execute(
            "SELECT number, follows, edit FROM edits WHERE number > ? ORDER BY number LIMIT ?",
            (next(reversed(self._read), 0), MOST_EDITS + 1),
        ).fetchall()
        if len(self._read) + len(rows) > MOST_EDITS:
            raise self._damaged(f"it holds more than {MOST_EDITS} edits")
        for number, follows, text in rows:
            if type(follows) is not int or not (follows == 0 or follows in self._read):
                raise self._damaged(f"edit {number} follows {follows!r}, which is not there")
            self._read[number] = KeptEdit(number, follows, self._edit(number, text))
        return self._read

    def _edit(self, number: int, text: Any) -> Edit:
        """The edit of a row, which a stranger may have written."""
        if not isinstance(text, str) or len(text) > MOST_LETTERS:
            raise self._damaged(f"edit {number} is no text of an edit")
        try:
            (edit,) = from_json_lines(text, self.path).edits
        except (MediaError, ValueError) as error:
            raise self._damaged(f"edit {number} is none: {error}") from error
        return edit

    def _damaged(self, problem: str) -> TrackError:
        return TrackError(
            f"{self.path}: its edits are damaged ({problem}); take a copy of the track, or solve "
            "again with --edits"
        )

    def close(self) -> None:
        """Release the file."""
        self._connection.close()

    def __enter__(self) -> "EditJournal":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
