"""Read a track: any frame at once."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from pipeline.track.blobs import unpack
from pipeline.track.header import Header, read_header
from pipeline.track.schema import ENDING, MAGIC, has_table, open_existing, reading
from stages.blank import color_owners
from stages.media import FrameRange
from stages.mesh import Mesh
from stages.snapshot import Snapshot
from warp_kernels.color_model import CHANNELS
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
        try:
            with reading(path):
                self.header: Header = read_header(path, self._connection)
        except BaseException:
            self._connection.close()
            raise

    @cached_property
    def rows(self) -> tuple[FrameRow, ...]:
        """All frames, in order."""
        columns = "frame, pts, shot, triangle_count, rmse"
        found = self._all(f"SELECT {columns} FROM frames ORDER BY frame")
        return tuple(FrameRow(*row) for row in found)

    @property
    def shots(self) -> tuple[int, ...]:
        """The frames with which shots begin, in order."""
        return tuple(sorted({row.shot for row in self.rows}))

    def last(self) -> FrameRow | None:
        """The last frame, or None if there is none."""
        columns = "frame, pts, shot, triangle_count, rmse"
        found = self._all(f"SELECT {columns} FROM frames ORDER BY frame DESC LIMIT 1")
        return FrameRow(*found[0]) if found else None

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
            "SELECT pts, vertex_count, triangle_count, next_vertex_id, next_triangle_id,"
            " vertices, coefficients, energies, counts, triangles, vertex_ids, triangle_ids"
            " FROM frames JOIN meshes USING (frame)"
            " JOIN topologies ON topologies.frame = frames.topology WHERE frames.frame = ?",
            frame,
        )
        if not found:
            raise TrackError(f"{self.path}: holds no frame {frame}; see trimotion info {self.path}")
        pts, V, T, next_vertex, next_triangle, *blobs = found[0]
        try:
            return self._assembled(frame, pts, V, T, (next_vertex, next_triangle), blobs)
        except ValueError as error:
            raise TrackError(
                f"{self.path}: frame {frame} is damaged ({error}); take a copy of the track, or "
                "solve again"
            ) from error

    def snapshots(self, rows: list[FrameRow]) -> Iterator[Snapshot]:
        """What some frames became, one at a time."""
        for row in rows:
            yield self.snapshot(row.frame)

    def _assembled(
        self,
        frame: int,
        pts: int,
        V: int,
        T: int,
        next_ids: tuple[int, int],
        blobs: Sequence[bytes],
    ) -> Snapshot:
        vertices, coefficients, energies, counts, triangles, vertex_ids, triangle_ids = blobs
        info, model = self.header.info, self.header.model
        mesh = Mesh(
            width=info.width,
            height=info.height,
            vertices=unpack(vertices, "<f8", (V, 2)),
            triangles=_corners(unpack(triangles, "<i4", (T, 3)), V),
            vertex_ids=unpack(vertex_ids, "<i8", (V,)),
            triangle_ids=unpack(triangle_ids, "<i8", (T,)),
            next_vertex_id=next_ids[0],
            next_triangle_id=next_ids[1],
        )
        covered = unpack(counts, "<i8", (T,))
        colors = unpack(coefficients, "<f8", (T, CHANNELS, model.term_count))
        return Snapshot(
            frame_index=frame,
            pts=pts,
            time_base=Fraction(info.time_base),
            mesh=mesh,
            model=model,
            coefficients=colors[color_owners(mesh, covered)],  # black in tracks of old programs
            energies=unpack(energies, "<f8", (T,)),
            counts=covered,
            limits=self._limits(frame, T),
        )

    def _limits(self, frame: int, T: int) -> np.ndarray | None:
        """What colours keep to; constant ones need nothing, and old tracks say nothing."""
        with reading(self.path):
            if not has_table(self._connection, "limits"):
                return None
        found = self._all("SELECT limits FROM limits WHERE frame = ?", frame)
        return unpack(found[0][0], "u1", (T, 2, CHANNELS)) if found else None

    def _all(self, statement: str, *values: object) -> list[Any]:
        with reading(self.path):
            return self._connection.execute(statement, values).fetchall()

    def close(self) -> None:
        """Release the file."""
        self._connection.close()

    def __enter__(self) -> "TrackReader":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def is_track(path: Path) -> bool:
    """Whether a file is meant to be a track: by its ending, or by how it begins.

    Args:
        path: Its name.
    """
    if path.suffix.lower() == ENDING:
        return True
    try:
        with path.open("rb") as file:
            return file.read(len(MAGIC)) == MAGIC
    except OSError:
        return False


def _corners(triangles: np.ndarray, vertex_count: int) -> np.ndarray:
    """Refuse numbers of vertices that there are not: kernels would read beyond their arrays."""
    if triangles.size and not 0 <= triangles.min() <= triangles.max() < vertex_count:
        raise ValueError("a triangle of unknown vertices")
    return triangles
