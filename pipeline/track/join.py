"""Put tracks of successive ranges together."""

import sqlite3
from collections.abc import Sequence
from contextlib import ExitStack, closing
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

from pipeline.track.agreement import differing_flags
from pipeline.track.header import Header, write_header
from pipeline.track.reader import TrackReader
from pipeline.track.schema import (
    LATER,
    TABLES,
    create,
    has_table,
    need_table,
    put_in_place,
    writing,
)
from stages.media import FrameRange
from stages.media.writing.commit import PendingFile
from warp_kernels.errors import OptionError, TrackError


def join(parts: Sequence[Path], output: Path, frame_range: FrameRange | None = None) -> Header:
    """Put tracks together; the rows are those of the parts, to the bit.

    Args:
        parts: The tracks, in any order.
        output: The joined track; it appears when it is complete.
        frame_range: The range that the parts are all of; None to conclude it from them.

    Returns:
        Its header.

    Raises:
        OptionError: If the parts do not follow each other.
        TrackError: If a part cannot be read, is unfinished or was made in another way.
        OutputError: If the joined track cannot be written.
    """
    with ExitStack() as stack:
        readers = [stack.enter_context(TrackReader(path)) for path in parts]
        for reader in readers:
            _check_finished(reader)
            reader.check()
        readers.sort(key=lambda reader: reader.rows[0].frame)
        for reader in readers[1:]:
            _check_alike(readers[0], reader)
        step = readers[0].header.frame_range.step
        for before, after in pairwise(readers):
            _check_follows(before, after, step)
        header = readers[0].header.with_range(frame_range or _whole_range(readers))
        ordered = [reader.path for reader in readers]
    pending = PendingFile(output)
    try:
        with writing(output), closing(create(pending.path)) as connection:
            for path in ordered:
                _copy(connection, path)
            write_header(connection, replace(header, finished=True))
    except BaseException:
        pending.discard()
        raise
    put_in_place(pending)
    return header


def _check_finished(reader: TrackReader) -> None:
    if not reader.rows or not reader.header.finished:
        at = f"it ends with frame {reader.rows[-1].frame}" if reader.rows else "it holds no frame"
        wanted = reader.header.frame_range
        raise TrackError(
            f"{reader.path}: is unfinished ({at} of {wanted}); finish it with trimotion solve "
            "--resume"
        )


def _check_alike(first: TrackReader, other: TrackReader) -> None:
    mine, theirs = first.header, other.header
    if (mine.source.size, mine.source.digest) != (theirs.source.size, theirs.source.digest):
        raise TrackError(
            f"{other.path}: was made from another source than {first.path}; join tracks of one"
        )
    differing = differing_flags(mine.options, theirs.options)
    if mine.model != theirs.model:
        differing.append(f"colours {theirs.model.name} instead of {mine.model.name}")
    if mine.frame_range.step != theirs.frame_range.step:
        differing.append(f"--frames {theirs.frame_range} instead of {mine.frame_range}")
    if differing:
        raise TrackError(
            f"{other.path}: was made in another way than {first.path} ({', '.join(differing)}); "
            "solve it again with the same options"
        )


def _check_follows(before: TrackReader, after: TrackReader, step: int) -> None:
    last, first = before.rows[-1].frame, after.rows[0].frame
    if first <= last:
        raise OptionError(
            f"{after.path}: begins with frame {first}, and {before.path} holds frames up to "
            f"{last}; join tracks that do not overlap"
        )
    if first != last + step:
        raise OptionError(
            f"{after.path}: begins with frame {first}, and {before.path} ends with {last}; "
            f"frames {last + step} to {first - step} are missing: solve them as well"
        )


def _whole_range(readers: Sequence[TrackReader]) -> FrameRange:
    """From the first part's beginning to the last one's end."""
    first, last = (readers[place].header.frame_range for place in (0, -1))
    joined = replace(first, last=last.last, end_time=last.end_time)
    count = readers[0].header.info.frame_count
    is_whole = joined.last is not None and joined == FrameRange(last=joined.last)
    return FrameRange() if is_whole and readers[-1].rows[-1].frame + 1 == count else joined


def _copy(connection: sqlite3.Connection, path: Path) -> None:
    """Copy all frames of a part."""
    connection.execute("ATTACH ? AS part", (f"{path.absolute().as_uri()}?mode=ro",))
    connection.execute("BEGIN")
    for table in TABLES:
        if not has_table(connection, table, "part"):
            continue
        if table in LATER:
            need_table(connection, table)
        connection.execute(f"INSERT INTO {table} SELECT * FROM part.{table} ORDER BY frame")
    connection.execute("COMMIT")
    connection.execute("DETACH part")
