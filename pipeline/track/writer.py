"""Write a track while it is made; every frame is there to stay once it is written."""

import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from types import TracebackType

import numpy as np

from pipeline.track.header import Header, write_header
from pipeline.track.packing.compact import pack_colors, pack_energies, pack_numbers, pack_places
from pipeline.track.packing.plain import pack
from pipeline.track.packing.topologies import (
    BaseTriangles,
    base_frame,
    pack_topology,
    read_base,
    topology_of,
)
from pipeline.track.schema import (
    MOST_TRIANGLES,
    complete,
    create,
    need_table,
    open_existing,
    put_in_place,
    writing,
)
from stages.media.writing.commit import PendingFile
from stages.mesh import Mesh
from stages.snapshot import Snapshot
from warp_kernels.errors import OutputError, TrackError


class TrackWriter:
    """Appends frames to a track; a context manager.

    Each frame is one transaction: whatever ends the run, the track holds all frames up to the
    last one that was written, and can be read and continued. Without a frame there is no file.
    """

    def __init__(self, path: Path, header: Header) -> None:
        """Begin a track with its first frame, in place of what stands there by then.

        Args:
            path: Its file.
            header: How it is made.
        """
        self._path = path
        self._header = replace(header, finished=False)
        self._connection: sqlite3.Connection | None = None
        self._topology: Mesh | None = None
        self._shot = -1
        self._holder = -1
        self._base: BaseTriangles | None = None

    @classmethod
    def resume(cls, path: Path, header: Header, last: Snapshot, shot: int) -> "TrackWriter":
        """Go on with a track.

        Args:
            path: Its file.
            header: How it is made, from now on.
            last: Its last snapshot.
            shot: The shot of that.

        Raises:
            TrackError: If it cannot be read.
            OutputError: If it cannot be written.
        """
        writer = cls(path, header)
        writer._connection = open_existing(path)
        with writing(path):
            write_header(writer._connection, writer._header)
            complete(writer._connection)
            (writer._holder,) = writer._connection.execute(
                "SELECT topology FROM frames WHERE frame = ?", (last.frame_index,)
            ).fetchone()
            writer._base = _base_of(path, writer._connection, writer._holder)
        writer._topology, writer._shot = last.mesh, shot
        return writer

    def _opened(self) -> sqlite3.Connection:
        """The file, made when the first frame comes: before that nothing is replaced."""
        if self._connection is None:
            pending = PendingFile(self._path)
            try:
                with writing(self._path), closing(create(pending.path)) as connection:
                    write_header(connection, self._header)
            except BaseException:
                pending.discard()
                raise
            put_in_place(pending)
            self._connection = open_existing(self._path)
        return self._connection

    def write(self, snapshot: Snapshot, shot: int, *, more: bool = False) -> None:
        """Append a frame, for good.

        Args:
            snapshot: What the frame became.
            shot: Number of the frame with which its shot begins.
            more: Whether the next frame belongs to it: either both are there or none is.

        Raises:
            OutputError: If it cannot be written.
        """
        mesh, frame = snapshot.mesh, snapshot.frame_index
        if mesh.triangle_count > MOST_TRIANGLES:
            raise OutputError(
                self._path,
                f"frame {frame} has {mesh.triangle_count} triangles, a track holds up to "
                f"{MOST_TRIANGLES}",
                "ask for fewer",
            )
        rows = self._rows(snapshot, shot)
        connection = self._opened()
        with writing(self._path):
            if not connection.in_transaction:
                connection.execute("BEGIN IMMEDIATE")
            if "locks" in rows:
                need_table(connection, "locks")
            for table, values in rows.items():
                places = ", ".join("?" * len(values))
                connection.execute(f"INSERT INTO {table} VALUES ({places})", values)
            if not more:
                connection.execute("COMMIT")
        self._topology, self._shot = mesh, shot

    def _rows(self, snapshot: Snapshot, shot: int) -> dict[str, tuple[object, ...]]:
        """What of a frame goes into which table."""
        mesh, frame = snapshot.mesh, snapshot.frame_index
        rows: dict[str, tuple[object, ...]] = {}
        if shot != self._shot:
            self._base = None  # parts of a track stand alone
        if shot != self._shot or not _same_topology(self._topology, mesh):
            self._holder = frame
            topology = topology_of(mesh)
            packed = pack_topology(topology, self._base)
            rows["topologies"] = (frame, *packed)
            if base_frame(packed[0]) is None:
                self._base = BaseTriangles(frame, len(packed[0]), topology)
        rows["frames"] = (
            *(frame, snapshot.pts, shot, self._holder, mesh.vertex_count, mesh.triangle_count),
            *(mesh.next_vertex_id, mesh.next_triangle_id, snapshot.rmse),
        )
        places, energies = pack_places(mesh.vertices), pack_energies(snapshot.energies)
        coefficients, limits = pack_colors(
            mesh, snapshot.model, snapshot.coefficients, snapshot.counts, snapshot.limits
        )
        rows["meshes"] = (frame, places, coefficients, energies, pack_numbers(snapshot.counts))
        if limits is not None:
            rows["limits"] = (frame, limits)
        if not snapshot.locks.is_empty:
            locks = snapshot.locks
            held = (pack(ids, "<i8") for ids in (locks.vertices, locks.edges, locks.bare))
            rows["locks"] = (frame, *held)
        return rows

    def finish(self) -> None:
        """Note that the whole range is there.

        Raises:
            OutputError: If it cannot be written.
        """
        if self._connection is not None:
            with writing(self._path):
                write_header(self._connection, replace(self._header, finished=True))

    def __enter__(self) -> "TrackWriter":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._connection is not None:
            self._connection.close()


def _same_topology(before: Mesh | None, mesh: Mesh) -> bool:
    """Whether two meshes have the same triangles of the same numbers in the same order."""
    if before is None:
        return False
    pairs = (
        (before.triangles, mesh.triangles),
        (before.vertex_ids, mesh.vertex_ids),
        (before.triangle_ids, mesh.triangle_ids),
    )
    return all(one is other or np.array_equal(one, other) for one, other in pairs)


def _base_of(path: Path, connection: sqlite3.Connection, holder: int) -> BaseTriangles | None:
    """By what a track that goes on tells its topologies, as one that was never left would."""
    try:
        return read_base(connection, holder)
    except ValueError as error:
        raise TrackError(f"{path}: frame {holder} is damaged ({error}); solve again") from error
