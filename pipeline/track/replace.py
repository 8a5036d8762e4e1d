"""Put frames that were solved anew in place of those that a track holds."""

from dataclasses import replace
from pathlib import Path

from pipeline.options.edit_log import EditLog
from pipeline.track.header import read_header, write_header
from pipeline.track.plain_values import to_plain
from pipeline.track.schema import (
    LATER,
    TABLES,
    complete,
    has_table,
    need_table,
    open_existing,
    writing,
)


def replace_frames(path: Path, part: Path, first: int, last: int, edits: EditLog) -> None:
    """Replace whole shots of a track: either all of their frames are replaced, or none is.

    Args:
        path: The track.
        part: A track of one source with it that holds these shots.
        first: Number of their first frame.
        last: Number of their last frame.
        edits: With what the track's frames have been solved from then on.

    Raises:
        OutputError: If it cannot be written.
        TrackError: If one of them is damaged.
    """
    connection = open_existing(path)
    try:
        with writing(path):
            header = read_header(path, connection)
            connection.execute("ATTACH ? AS part", (f"{part.absolute().as_uri()}?mode=ro",))
            connection.execute("BEGIN IMMEDIATE")
            complete(connection)
            for table in TABLES:
                is_there = has_table(connection, table, "part")
                if is_there and table in LATER:
                    need_table(connection, table)
                if not has_table(connection, table):
                    continue
                bounds = (first, last)
                connection.execute(f"DELETE FROM {table} WHERE frame BETWEEN ? AND ?", bounds)
                if is_there:
                    rows = f"SELECT * FROM part.{table} WHERE frame BETWEEN ? AND ? ORDER BY frame"
                    connection.execute(f"INSERT INTO {table} {rows}", bounds)
            options = {**header.options, "edits": to_plain(edits)}
            write_header(connection, replace(header, options=options))
            connection.execute("COMMIT")
    finally:
        connection.close()  # what was not committed is undone
