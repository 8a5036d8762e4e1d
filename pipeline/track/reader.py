"""Read a track: any frame at once."""

import reprlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.track.header import Header, read_header
from pipeline.track.packing.compact import (
    unpack_colors,
    unpack_energies,
    unpack_numbers,
    unpack_places,
)
from pipeline.track.packing.plain import unpack_rows
from pipeline.track.packing.topologies import Topologies
from pipeline.track.schema import (
    ENDING,
    LAST,
    MAGIC,
    check_counts,
    has_table,
    open_existing,
    reading,
)
from stages.hand.locks import NO_LOCKS, Locks
from stages.media import FrameRange
from stages.mesh import Mesh
from stages.snapshot import Snapshot
from stages.solve.color_owners import color_owners
from stages.validate import assert_finite, assert_sound
from warp_kernels.errors import TrackError


@dataclass(frozen=True)
class FrameRow:
    """What a track says about a frame beside its mesh."""

    frame: int
    """Its number in the source."""
    pts: int
    """Presentation time [time base of the source]."""
    shot: int
    """Number of the frame with which its shot begins."""
    triangle_count: int
    """Triangles."""
    rmse: float
    """Error of the fit [code values]."""


class TrackReader:
    """An opened track; a context manager.

    Args:
        path: Its file.

    Raises:
        TrackError: If it is no whole track of this program's format.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._connection = open_existing(path)
        self._topologies = Topologies(self._connection)
        try:
            with reading(path):
                self.header: Header = read_header(path, self._connection)
        except BaseException:
            self._connection.close()
            raise

    @cached_property
    def rows(self) -> tuple[FrameRow, ...]:
        """All frames, in order.

        Raises:
            TrackError: If they are not frames of the track's range, shot after shot.
        """
        columns = "frame, pts, shot, triangle_count, rmse"
        found = self._all(f"SELECT {columns} FROM frames ORDER BY frame")
        rows = []
        before = None
        for values in found:
            row = FrameRow(*values)
            try:
                _check_row(row, before, self.header)
            except ValueError as error:
                raise self._damaged(row.frame, error) from error
            rows.append(row)
            before = row
        return tuple(rows)

    def check(self) -> None:
        """Read all frames, and keep none: whoever goes on with a track wants to know before.

        Raises:
            TrackError: If one is damaged.
        """
        for row in self.rows:
            self.snapshot(row.frame)

    @property
    def shots(self) -> tuple[int, ...]:
        """The frames with which shots begin, in order."""
        return tuple(sorted({row.shot for row in self.rows}))

    def last(self) -> FrameRow | None:
        """The last frame, or None if there is none."""
        return self.rows[-1] if self.rows else None

    def rows_in(self, wanted: FrameRange) -> list[FrameRow]:
        """The frames of a range.

        Args:
            wanted: The range; its times count from the source's first frame.
        """
        info = self.header.info
        return [
            row
            for row in self.rows
            if wanted.holds(row.frame, row.pts * info.time_base - info.start_time)
        ]

    def snapshot(self, frame: int) -> Snapshot:
        """What a frame became.

        Args:
            frame: Its number in the source.

        Raises:
            TrackError: If the track does not hold it, or is damaged.
        """
        found = self._all(
            "SELECT pts, topology, vertex_count, triangle_count, next_vertex_id, next_triangle_id,"
            " vertices, coefficients, energies, counts, triangles, vertex_ids, triangle_ids"
            " FROM frames JOIN meshes USING (frame)"
            " JOIN topologies ON topologies.frame = frames.topology WHERE frames.frame = ?",
            frame,
        )
        if not found:
            raise TrackError(f"{self.path}: holds no frame {frame}; see trimotion info {self.path}")
        pts, holder, V, T, *next_ids, vertices, coefficients, energies, counts = found[0][:10]
        try:
            check_counts(V, T)
            _check_numbers(pts, holder, *next_ids)
            mesh = self._mesh(V, T, next_ids, vertices, found[0][10:])
            model = self.header.model
            covered = unpack_numbers(counts, T)
            colors, limits = unpack_colors(mesh, model, coefficients, self._limits(frame))
            blank = np.flatnonzero(covered == 0)
            if len(blank):  # of no meaning, and black in tracks of old programs
                colors[blank] = colors[color_owners(mesh, covered)[blank]]
            snapshot = Snapshot(
                frame_index=frame,
                pts=pts,
                time_base=Fraction(self.header.info.time_base),
                mesh=mesh,
                model=model,
                coefficients=colors,
                energies=unpack_energies(energies, T),
                counts=covered,
                limits=limits,
                locks=self._locks(frame, mesh),
            )
            assert_finite(snapshot)
        except ValueError as error:
            raise self._damaged(frame, error) from error
        return snapshot

    def snapshots(self, rows: list[FrameRow]) -> Iterator[Snapshot]:
        """What some frames became, one at a time."""
        for row in rows:
            yield self.snapshot(row.frame)

    def _mesh(
        self, V: int, T: int, next_ids: Sequence[int], vertices: Any, topology: Sequence[Any]
    ) -> Mesh:
        """The triangles of a frame, checked before more is unpacked."""
        with reading(self.path):
            found = self._topologies.unpack(topology, V, T)
        mesh = Mesh(
            width=self.header.info.width,
            height=self.header.info.height,
            vertex_ids=found.vertex_ids,
            triangle_ids=found.triangle_ids,
            triangles=found.triangles,
            vertices=unpack_places(vertices, V),
            next_vertex_id=next_ids[0],
            next_triangle_id=next_ids[1],
        )
        assert_sound(mesh)
        return mesh

    def _damaged(self, frame: object, error: Exception) -> TrackError:
        return TrackError(
            f"{self.path}: frame {reprlib.repr(frame)} is damaged ({error}); take a copy of the "
            "track, or solve again"
        )

    def _limits(self, frame: int) -> Any:
        """The blob of what colours keep to; constant ones need none, and old tracks have none."""
        with reading(self.path):
            if not has_table(self._connection, "limits"):
                return None
        found = self._all("SELECT limits FROM limits WHERE frame = ?", frame)
        return found[0][0] if found else None

    def _locks(self, frame: int, mesh: Mesh) -> Locks:
        """What of a frame's mesh a person holds fast."""
        with reading(self.path):
            if not has_table(self._connection, "locks"):
                return NO_LOCKS
        found = self._all("SELECT vertices, edges, bare FROM locks WHERE frame = ?", frame)
        if not found:
            return NO_LOCKS
        vertices, edges, bare = found[0]
        most = 3 * mesh.triangle_count
        return NO_LOCKS.adding(
            unpack_rows(vertices, "<i8", 1, most)[:, 0],
            unpack_rows(edges, "<i8", 2, most),
            unpack_rows(bare, "<i8", 1, most)[:, 0],
        ).within(mesh)

    def _all(self, statement: str, *values: object) -> list[Any]:
        with reading(self.path):
            return self._connection.execute(statement, values).fetchall()

    def close(self) -> None:
        """Release the file."""
        self._connection.close()

    def __enter__(self) -> "TrackReader":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def is_track(path: Path) -> bool:
    """Whether a file is meant to be a track: by its ending, or by how it begins.

    Args:
        path: Its name.
    """
    if path.suffix.lower() == ENDING:
        return True
    try:
        if not path.is_file():  # who opens a pipe waits for its other end
            return False
        with path.open("rb") as file:
            return file.read(len(MAGIC)) == MAGIC
    except (OSError, ValueError):
        return False


def _check_row(row: FrameRow, before: FrameRow | None, header: Header) -> None:
    """Refuse what SQLite may hold and no track does: it lets every column hold everything."""
    wanted = header.frame_range
    numbers = (row.frame, row.pts, row.shot, row.triangle_count)
    if not all(type(number) is int for number in numbers) or type(row.rmse) is not float:
        raise ValueError("numbers of other types")
    if not (0 <= row.shot <= row.frame <= LAST and abs(row.pts) <= LAST and 0 <= row.rmse < 1e9):
        raise ValueError("impossible numbers")
    beyond = wanted.last is not None and row.frame > wanted.last
    if row.frame < wanted.first or beyond or not wanted.is_in_step(row.frame):
        raise ValueError(f"it is none of the frames {wanted}")
    if header.info.kind == "video" and wanted.start_time is None:
        expected = wanted.first if before is None else before.frame + wanted.step
        if row.frame != expected:
            raise ValueError(f"frame {expected} is missing before it")
    if before is not None:
        if row.pts <= before.pts:
            raise ValueError("its time is not after that of the frame before")
        if row.shot != before.shot and row.shot <= before.frame:
            raise ValueError(f"its shot begins with frame {row.shot}, before an earlier one ends")


def _check_numbers(pts: Any, holder: Any, *next_ids: Any) -> None:
    """Refuse numbers that are none."""
    if not all(type(number) is int for number in (pts, holder, *next_ids)):
        raise ValueError("numbers of other types")
    if not all(0 < number <= LAST for number in next_ids):
        raise ValueError("impossible numbers of vertices or triangles")
