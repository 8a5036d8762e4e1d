"""Put tracks of successive ranges together."""

import sqlite3
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

from pipeline.track.agreement import differing_flags
from pipeline.track.header import Header, write_header
from pipeline.track.joints import Joint, finished_joints
from pipeline.track.packing.topologies import make_whole, pack_topology, read_topology
from pipeline.track.reader import FrameRow, TrackReader
from pipeline.track.schema import (
    LATER,
    TABLES,
    create,
    has_table,
    need_table,
    open_existing,
    put_in_place,
    writing,
)
from stages.media import FrameRange
from stages.media.writing.commit import PendingFile
from warp_kernels.errors import OptionError, TrackError


@dataclass(frozen=True)
class _Piece:
    """A track that is joined."""

    path: Path
    header: Header
    rows: tuple[FrameRow, ...]

    @property
    def first(self) -> int:
        """Its first frame."""
        return self.rows[0].frame

    @property
    def last(self) -> int:
        """Its last frame."""
        return self.rows[-1].frame


def join(
    parts: Sequence[Path], output: Path, frame_range: FrameRange | None = None, blend: int = 0
) -> Header:
    """Put tracks together; the rows are those of the parts, to the bit.

    Args:
        parts: The tracks, in any order.
        output: The joined track; it appears when it is complete.
        frame_range: The range that the parts are all of; None to conclude it from them.
        blend: Last frames over which parts that overlap fade into each other; 0 if none may.

    Returns:
        Its header.

    Raises:
        OptionError: If the parts do not follow each other.
        TrackError: If a part cannot be read, is unfinished or was made in another way.
        OutputError: If the joined track cannot be written.
    """
    found = sorted(map(_checked, parts), key=lambda part: part.first)
    for part in found[1:]:
        _check_alike(found[0], part)
    joints = [_joint(before, after, blend) for before, after in pairwise(found)]
    header = found[0].header.with_range(frame_range or _whole_range(found))
    begins = [
        found[0].first,
        *(part.first if j is None else j.first for part, j in zip(found[1:], joints, strict=True)),
    ]
    pending = PendingFile(output)
    try:
        with writing(output), closing(create(pending.path)) as connection:
            for part, begin, following in zip(found, begins, [*begins[1:], None], strict=True):
                _copy(connection, part, begin, following)
            write_header(connection, replace(header, finished=True))
        header = finished_joints(pending.path, header, [j for j in joints if j is not None])
    except BaseException:
        pending.discard()
        raise
    put_in_place(pending)
    return header


def _checked(path: Path) -> _Piece:
    """A part that is whole; it is closed again, for there may be more than files can be open."""
    with TrackReader(path) as reader:
        _check_finished(reader)
        reader.check()
        return _Piece(path, reader.header, reader.rows)


def _check_finished(reader: TrackReader) -> None:
    if not reader.rows or not reader.header.finished:
        at = f"it ends with frame {reader.rows[-1].frame}" if reader.rows else "it holds no frame"
        wanted = reader.header.frame_range
        raise TrackError(
            f"{reader.path}: is unfinished ({at} of {wanted}); finish it with trimotion solve "
            "--resume"
        )


def _check_alike(first: _Piece, other: _Piece) -> None:
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


def _joint(before: _Piece, after: _Piece, blend: int) -> Joint | None:
    """How a part goes on where another one ends; None if it begins with the frame after that."""
    last, first, step = before.last, after.first, before.header.frame_range.step
    common = (last - first) // step + 1
    if first == last + step:
        return None
    if first > last:
        raise OptionError(
            f"{after.path}: begins with frame {first}, and {before.path} ends with {last}; "
            f"frames {last + step} to {first - step} are missing: solve them as well"
        )
    if not blend:
        raise OptionError(
            f"{after.path}: begins with frame {first}, and {before.path} holds frames up to "
            f"{last}; join tracks that do not overlap, or let them fade with --blend N"
        )
    if step != 1:
        raise OptionError(f"--blend {blend}: takes every frame; solve without x{step}")
    if common < blend:
        raise OptionError(
            f"--blend {blend}: {before.path} and {after.path} have {common} frames in common; "
            f"choose --blend {common} or fewer"
        )
    if after.last - last < blend:
        raise OptionError(
            f"{after.path}: ends {max(0, after.last - last)} frames after {before.path}, and they "
            f"fade over {blend}; choose a smaller --blend, or leave it out"
        )
    return Joint(last - blend + 1, before.path, blend)


def _whole_range(parts: Sequence[_Piece]) -> FrameRange:
    """From the first part's beginning to the last one's end."""
    first, last = (parts[place].header.frame_range for place in (0, -1))
    joined = replace(first, last=last.last, end_time=last.end_time)
    count = parts[0].header.info.frame_count
    is_whole = joined.last is not None and joined == FrameRange(last=joined.last)
    return FrameRange() if is_whole and parts[-1].last + 1 == count else joined


def _copy(connection: sqlite3.Connection, part: _Piece, begin: int, end: int | None) -> None:
    """Copy the frames of a part from one on, up to another one that is not copied."""
    connection.execute("ATTACH ? AS part", (f"{part.path.absolute().as_uri()}?mode=ro",))
    connection.execute("BEGIN")
    for table in TABLES:
        if not has_table(connection, table, "part"):
            continue
        if table in LATER:
            need_table(connection, table)
        connection.execute(
            f"INSERT INTO {table} SELECT * FROM part.{table} WHERE frame >= ? AND "
            "(? IS NULL OR frame < ?) ORDER BY frame",
            (begin, end, end),
        )
    if begin > part.first:
        _begin_with(connection, part, begin)
    connection.execute("COMMIT")
    connection.execute("DETACH part")


def _begin_with(connection: sqlite3.Connection, part: _Piece, begin: int) -> None:
    """Let a frame begin what came before it in its part: a shot, and a topology."""
    with closing(open_existing(part.path)) as source:
        (holder,) = source.execute(
            "SELECT topology FROM frames WHERE frame = ?", (begin,)
        ).fetchone()
        if holder < begin:
            connection.execute(
                "INSERT INTO topologies VALUES (?, ?, ?, ?)",
                (begin, *pack_topology(read_topology(source, holder))),
            )
        make_whole(connection, source, begin)
    for column in ("shot", "topology"):
        connection.execute(
            f"UPDATE frames SET {column} = ? WHERE frame >= ? AND {column} < ?",
            (begin, begin, begin),
        )
