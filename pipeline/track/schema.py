"""The form of a track's file.

One row per frame in `frames`, small, so that listing ten thousand of them is quick; what they
hold in `meshes`. A topology is stored with the frame that brought it and with the first frame of
every shot; the frames after it refer to it. All that the next frame depends on is stored to the
bit: a job that goes on from a row gives what an uninterrupted one gives.

Blobs are little-endian arrays, packed as `packing.plain` tells, all of those of format 1:

    meshes      vertices [V, 2] float64 (px), coefficients [T, 3, K] float64, energies [T] float64,
                counts [T] int64
    topologies  triangles [T, 3] int32, vertex_ids [V] int64, triangle_ids [T] int64
    limits      limits [T, 2, 3] uint8 of polynomial colours; tracks of earlier programs have none
    locks       ids of vertices [N], edges [M, 2] and bare triangles [K] that a person holds fast,
                all int64; only where there are some

Since format 2 numbers on the grid of solutions are told in fewer bytes, to the same bits: by
`packing.compact`, and triangles also by those of another frame: by `packing.topologies`. Blobs say
which they are by their first byte, so rows of both formats stand side by side in a track that goes
on.

Edits by hand that a person is at stand in `edits`, which is only ever appended to: a row names the
edit that it follows, so those that were undone stay. The last row of `edit_places` says which of
them is the last one in force. `pipeline.edit_log.journal` writes both, from the first change on;
until then the log with which the frames were solved, in the header, is all that there is.
"""

import os
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pipeline.track.guard import guard
from stages.media.writing.commit import PendingFile, output_error
from warp_kernels.errors import OutputError, TrackError

MAGIC = b"SQLite format 3\0"
"""How every file of SQLite begins."""
APPLICATION = 0x74726D6F
"""What marks a file of SQLite as a track ("trmo")."""
FORMAT = 2
"""Number of this form; a program that does not know it reads no such track."""
EARLIER = (1,)
"""Earlier forms that are read, and gone on with: all of their blobs are plain."""
LAST = 1 << 53
"""Beyond any number of a frame, of a vertex or of a time: what a double still holds exactly."""
ENDING = ".mtrk"
"""How the names of tracks end."""
MOST_BYTES = 1 << 27
"""Largest field that is read or written [bytes]: SQLite itself would take a gigabyte."""
MOST_TRIANGLES = 1 << 20
"""Most triangles of a frame: a stranger's file may not ask for more memory than they need."""
NO_TRACK = (
    "{}: is no mesh track; give a file that trimotion solve wrote, or convert a source with "
    "trimotion animate"
)
"""What to say about another file."""
WAIT = 10.0
"""How long to wait for another process that writes [s]."""

SCHEMA = """
CREATE TABLE header (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE frames (
    frame INTEGER PRIMARY KEY,
    pts INTEGER NOT NULL,
    shot INTEGER NOT NULL,
    topology INTEGER NOT NULL,
    vertex_count INTEGER NOT NULL,
    triangle_count INTEGER NOT NULL,
    next_vertex_id INTEGER NOT NULL,
    next_triangle_id INTEGER NOT NULL,
    rmse REAL NOT NULL
);
CREATE TABLE meshes (
    frame INTEGER PRIMARY KEY,
    vertices BLOB NOT NULL,
    coefficients BLOB NOT NULL,
    energies BLOB NOT NULL,
    counts BLOB NOT NULL
);
CREATE TABLE topologies (
    frame INTEGER PRIMARY KEY,
    triangles BLOB NOT NULL,
    vertex_ids BLOB NOT NULL,
    triangle_ids BLOB NOT NULL
);
"""

LATER = {
    "limits": "CREATE TABLE limits (frame INTEGER PRIMARY KEY, limits BLOB NOT NULL)",
    "locks": "CREATE TABLE locks (frame INTEGER PRIMARY KEY, vertices BLOB NOT NULL, "
    "edges BLOB NOT NULL, bare BLOB NOT NULL)",
    "edits": "CREATE TABLE edits (number INTEGER PRIMARY KEY, follows INTEGER NOT NULL, "
    "edit TEXT NOT NULL)",
    "edit_places": "CREATE TABLE edit_places (step INTEGER PRIMARY KEY, number INTEGER NOT NULL)",
}
"""Tables that tracks of earlier programs lack; all but the first are made when they are needed."""

TABLES = ("frames", "meshes", "topologies", "limits", "locks")
"""The tables whose rows belong to frames, `frame` first."""


def create(path: Path) -> sqlite3.Connection:
    """Make an empty track.

    Args:
        path: Its file, which must not exist.

    Raises:
        OutputError: If it cannot be made.
    """
    with writing(path):
        connection = _connect(path, "rwc")
        connection.executescript(
            f"PRAGMA application_id = {APPLICATION}; PRAGMA user_version = {FORMAT};"
            "PRAGMA synchronous = NORMAL;"
            f"BEGIN; {SCHEMA} {LATER['limits']}; COMMIT;"
        )
    return connection


def put_in_place(pending: PendingFile) -> None:
    """Give a track its name, in place of what stands there.

    Args:
        pending: The track, closed.

    Raises:
        OutputError: If the disk or the folder refuses.
    """
    target = pending.target
    try:
        # What a killed run left beside an old track must not be taken for the new one's.
        target.with_name(f"{target.name}-journal").unlink(missing_ok=True)
    except OSError as error:
        pending.discard()
        raise output_error(target, error) from error
    pending.commit()


def open_existing(path: Path) -> sqlite3.Connection:
    """Open a track, and undo what a killed run left half-written in it.

    Args:
        path: Its file.

    Raises:
        TrackError: If it is no whole track of this form.
    """
    _check_file(path)
    with reading(path):
        connection = _connect(path, "rw")
        try:
            connection.execute("PRAGMA synchronous = NORMAL")
            connection.execute("SELECT COUNT(*) FROM sqlite_master").fetchone()
            _check_form(path, connection)
        except sqlite3.Error:
            connection.close()
            _check_length(path)
            raise
        except BaseException:
            connection.close()
            raise
    return connection


def complete(connection: sqlite3.Connection) -> None:
    """Make a track of an earlier program, with which a run goes on, one of this form."""
    need_table(connection, "limits")
    connection.execute(f"PRAGMA user_version = {FORMAT}")


def need_table(connection: sqlite3.Connection, table: str) -> None:
    """Make a table of `LATER` if it is not there."""
    if not has_table(connection, table):
        connection.execute(LATER[table])


def check_counts(V: Any, T: Any) -> None:
    """Refuse numbers of vertices and triangles that no mesh has: so much memory is asked for.

    Raises:
        ValueError: If they are none.
    """
    if not (type(V) is int and type(T) is int):
        raise ValueError("numbers of other types")
    if not (1 <= T <= MOST_TRIANGLES and 3 <= V <= T + 2):
        raise ValueError(f"{V} vertices of {T} triangles")


def has_table(connection: sqlite3.Connection, table: str, schema: str = "main") -> bool:
    """Whether a track has a table: those of earlier programs lack some.

    Args:
        connection: The track.
        table: The table's name.
        schema: Under which name the track is attached.
    """
    names = f"SELECT 1 FROM {schema}.sqlite_master WHERE type = 'table' AND name = ?"
    return connection.execute(names, (table,)).fetchone() is not None


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Turn whatever a damaged track causes into one line.

    Args:
        path: Its file.
    """
    try:
        yield
    except sqlite3.Error as error:
        raise TrackError(
            f"{path}: the track is damaged ({error}); take a copy of it, or solve again"
        ) from error


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turn what hinders writing into one line.

    Args:
        path: The track's file.
    """
    try:
        yield
    except sqlite3.IntegrityError as error:
        raise OutputError(
            path, f"holds this frame already ({error})", "let one run at a time write to a track"
        ) from error
    except sqlite3.Error as error:
        raise OutputError(
            path,
            f"the track cannot be written ({error})",
            "check the folder, its rights, the free space and whether another run writes to it",
        ) from error


def _connect(path: Path, mode: str) -> sqlite3.Connection:
    # A rollback journal, not a write-ahead log: the latter needs memory that processes share,
    # which folders on a network do not have, and a second file beside the track.
    address = f"{path.absolute().as_uri()}?mode={mode}"
    connection = sqlite3.connect(
        address, uri=True, timeout=WAIT, isolation_level=None, check_same_thread=False
    )
    guard(connection, MOST_BYTES)
    return connection


def _check_file(path: Path) -> None:
    """Refuse what is no file of SQLite."""
    try:
        if os.path.exists(path) and not (path.is_file() or path.is_dir()):
            raise TrackError(f"{path}: is not a regular file; give the name of a track")
        with path.open("rb") as file:
            head = file.read(100)
    except (OSError, ValueError) as error:
        reason = str(getattr(error, "strerror", None) or error).lower()
        raise TrackError(f"{path}: cannot be read ({reason}); give the name of a track") from error
    if len(head) < 100 or not head.startswith(MAGIC):
        raise TrackError(NO_TRACK.format(path))


def _check_length(path: Path) -> None:
    """Tell what is wrong with the beginning of a file.

    Only after SQLite has found fault with it: a file that a killed run leaves may be short as
    well, until SQLite mends it by its journal.
    """
    with path.open("rb") as file:
        content = file.read(100)
    size = path.stat().st_size
    page = int.from_bytes(content[16:18], "big")
    declared = (65536 if page == 1 else page) * int.from_bytes(content[28:32], "big")
    if size < declared:
        raise TrackError(
            f"{path}: is cut off ({size} of {declared} bytes); copy it again, or solve again"
        )


def _check_form(path: Path, connection: sqlite3.Connection) -> None:
    """Refuse files of other programs and of other versions."""
    (application,) = connection.execute("PRAGMA application_id").fetchone()
    if application != APPLICATION:
        raise TrackError(NO_TRACK.format(path))
    (form,) = connection.execute("PRAGMA user_version").fetchone()
    if form not in (FORMAT, *EARLIER):
        raise TrackError(
            f"{path}: is a track of format {form}, and this program reads formats up to {FORMAT}; "
            "use the version that made it, or solve again"
        )
    # Views, triggers and tables of other columns would be a stranger's program.
    found = {
        (kind, name): " ".join((sql or "").split())
        for kind, name, sql in connection.execute("SELECT type, name, sql FROM sqlite_master")
    }
    for statement in filter(None, map(str.strip, SCHEMA.split(";"))):
        name = statement.split()[2]
        if found.pop(("table", name), None) != " ".join(statement.split()):
            raise TrackError(
                f"{path}: the track is damaged (its table {name} is missing or has another form); "
                "take a copy of it, or solve again"
            )
    for table, statement in LATER.items():
        if found.get(("table", table)) == statement:
            del found["table", table]
    if found:
        raise TrackError(
            f"{path}: the track is damaged (it holds {', '.join(map(repr, sorted(found)[0]))}, "
            "which no track does); take a copy of it, or solve again"
        )
