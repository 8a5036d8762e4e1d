"""Which triangles there are: whole, or by what is other than in a frame of the same shot before.

A topology that is told by another one names its frame. That one is whole, so two rows are read at
most, whichever frame is asked for; where too much is other a whole one comes again.
"""

import sqlite3
from dataclasses import dataclass
from typing import Any

import numpy as np

from pipeline.track.nouns import noun_for
from pipeline.track.packing.compact import pack_numbers, unpack_numbers
from pipeline.track.packing.plain import pack, unpack
from pipeline.track.packing.whole_numbers import is_whole, pack_whole, unpack_whole
from pipeline.track.schema import LAST, check_counts
from stages.mesh import Mesh

BY_ANOTHER = 0xFF
"""The first byte of triangles that are told by another frame's: eight bytes name it."""
MOST_SHARE = 0.4
"""A whole topology comes again where a difference would take this share of its bytes."""
KEPT = 8
"""Topologies by which others are told that a reader keeps: 100 frames have about as many."""
HEAD = 17
"""Bytes before the marks: what it is, the frame, and how long the marks are."""


@dataclass(frozen=True, eq=False)
class Connectivity:
    """The triangles of a frame, and under which numbers they go."""

    triangles: np.ndarray
    """Vertex rows, [T, 3] int32."""
    vertex_ids: np.ndarray
    """[V] int64, ascending."""
    triangle_ids: np.ndarray
    """[T] int64, ascending."""


@dataclass(frozen=True, eq=False)
class BaseTriangles:
    """A whole topology by which others are told."""

    frame: int
    """Its frame."""
    size: int
    """Bytes of its triangles."""
    topology: Connectivity
    """It."""


def topology_of(mesh: Mesh) -> Connectivity:
    """What of a mesh is topology."""
    return Connectivity(mesh.triangles, mesh.vertex_ids, mesh.triangle_ids)


def pack_topology(
    topology: Connectivity, base: BaseTriangles | None = None
) -> tuple[bytes, bytes, bytes]:
    """The blobs of a topology: triangles, ids of vertices, ids of triangles.

    Args:
        topology: The topology.
        base: By which it may be told; None for whole.
    """
    vertex_ids, triangle_ids = (
        pack_numbers(np.diff(ids, prepend=0))
        for ids in (topology.vertex_ids, topology.triangle_ids)
    )
    if base is not None:
        difference = _difference(topology, base)
        if len(difference) < MOST_SHARE * base.size:
            return difference, vertex_ids, triangle_ids
    return pack_whole(topology.triangles.T) or b"", vertex_ids, triangle_ids


def base_frame(blob: Any) -> int | None:
    """The frame by whose triangles some are told; None if they are told whole.

    Raises:
        ValueError: If that cannot be read.
    """
    if not isinstance(blob, bytes):
        raise ValueError(f"{noun_for(blob)} instead of bytes")
    if not blob or blob[0] != BY_ANOTHER:
        return None
    frame = int.from_bytes(blob[1:9], "little")
    if len(blob) < HEAD or frame > LAST:
        raise ValueError("triangles as in a frame that cannot be")
    return frame


class Topologies:
    """Unpacks topologies of a track, and keeps the last ones by which others are told.

    What is kept is taken for what the file has only while its bytes are the same.

    Args:
        connection: The track.
    """

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._connection = connection
        self._known: dict[int, tuple[Any, Connectivity]] = {}

    def read(self, frame: int) -> Connectivity:
        """The topology that a frame brought.

        Args:
            frame: The frame.

        Raises:
            ValueError: If it is not there, or damaged.
        """
        blobs, sizes = _row(self._connection, frame)
        return self.unpack(blobs, *sizes)

    def unpack(self, blobs: Any, V: int, T: int) -> Connectivity:
        """Unpack a topology.

        Args:
            blobs: As `pack_topology` gives them.
            V: Number of vertices.
            T: Number of triangles.

        Raises:
            ValueError: If they are damaged.
        """
        named = base_frame(blobs[0])
        if named is None:
            return _unpack_whole(blobs, V, T)
        ids = _unpack_both(blobs, V, T)
        return Connectivity(_changed(blobs[0], self._base(named), *ids), *ids)

    def _base(self, frame: int) -> Connectivity:
        """A topology by which others are told: a quarter of the time of reading a frame."""
        row = blobs, sizes = _row(self._connection, frame)
        known, base = self._known.pop(frame, (None, None))
        if base is None or known != row:
            if base_frame(blobs[0]) is not None:
                raise ValueError("its triangles are told by others that are told by others")
            base = _unpack_whole(blobs, *sizes)
            if not _are_rows(base.triangles, len(base.vertex_ids)):
                raise ValueError("triangles as in a frame that has none such")
        self._known[frame] = row, base  # behind those that were used earlier
        if len(self._known) > KEPT:
            del self._known[next(iter(self._known))]
        return base


def read_topology(connection: sqlite3.Connection, frame: int) -> Connectivity:
    """The topology that a frame brought.

    Args:
        connection: The track.
        frame: The frame.

    Raises:
        ValueError: If it is not there, or damaged.
    """
    return Topologies(connection).read(frame)


def read_base(connection: sqlite3.Connection, frame: int) -> BaseTriangles:
    """The whole topology by which a writer tells those after one.

    Args:
        connection: The track.
        frame: The frame that brought the last topology.

    Raises:
        ValueError: If it is not there, or damaged.
    """
    named = base_frame(_row(connection, frame)[0][0])
    frame = frame if named is None else named
    (triangles, *_), _ = _row(connection, frame)
    return BaseTriangles(frame, len(triangles), read_topology(connection, frame))


def make_whole(connection: sqlite3.Connection, part: sqlite3.Connection, first: int) -> None:
    """Tell whole what frames of a range tell by frames before it.

    Args:
        connection: A track that has them from a frame on.
        part: The track from which they were copied.
        first: That frame.

    Raises:
        ValueError: If one is damaged.
    """
    query = "SELECT frame, triangles FROM topologies WHERE frame >= ?"
    for frame, blob in connection.execute(query, (first,)).fetchall():
        named = base_frame(blob)
        if named is not None and named < first:
            triangles = pack_topology(read_topology(part, frame))[0]
            update = "UPDATE topologies SET triangles = ? WHERE frame = ?"
            connection.execute(update, (triangles, frame))


def _unpack_whole(blobs: Any, V: int, T: int) -> Connectivity:
    return Connectivity(_unpack_triangles(blobs[0], T, V), *_unpack_both(blobs, V, T))


def _unpack_both(blobs: Any, V: int, T: int) -> list[np.ndarray]:
    """Ids of vertices, [V], and of triangles, [T]."""
    return [_unpack_ids(blob, count) for blob, count in zip(blobs[1:], (V, T), strict=True)]


def _unpack_ids(blob: Any, count: int) -> np.ndarray:
    numbers = unpack_numbers(blob, count)
    return np.cumsum(numbers) if is_whole(blob) else numbers


def _unpack_triangles(blob: bytes, T: int, V: int) -> np.ndarray:
    """Rows of vertices, [T, 3] int32."""
    if not is_whole(blob):
        return unpack(blob, "<i4", (T, 3))
    found = unpack_whole(blob, (3, T))
    if not _are_rows(found, V):
        raise ValueError("a triangle of unknown vertices")
    triangles = np.empty((T, 3), dtype=np.int32)
    for corner in range(3):  # a third of the time of turning it all at once
        triangles[:, corner] = found[corner]
    return triangles


def _row(connection: sqlite3.Connection, frame: int) -> tuple[Any, tuple[int, int]]:
    """Blobs of a topology, and numbers of its vertices and triangles."""
    found = connection.execute(
        "SELECT triangles, vertex_ids, triangle_ids, vertex_count, triangle_count"
        " FROM topologies JOIN frames USING (frame) WHERE frame = ?",
        (frame,),
    ).fetchone()
    if found is None:
        raise ValueError(f"frame {frame} with its triangles is missing")
    check_counts(*found[3:])
    return found[:3], found[3:]


def _rows_in(ids: np.ndarray, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each wanted number its row among ascending ones, and whether it is there."""
    rows = np.searchsorted(ids, wanted)
    rows[rows == len(ids)] = 0
    return rows, ids.take(rows) == wanted


def _difference(topology: Connectivity, base: BaseTriangles) -> bytes:
    """Marks of the triangles that are as in the base, and all others."""
    rows, kept = _rows_in(base.topology.triangle_ids, topology.triangle_ids)
    there = base.topology.vertex_ids[base.topology.triangles][rows]
    kept &= (there == topology.vertex_ids[topology.triangles]).all(axis=1)
    marks = pack(np.packbits(kept), "u1")
    others = pack_whole(topology.triangles[~kept].T) or b""
    head = bytes([BY_ANOTHER]) + base.frame.to_bytes(8, "little")
    return head + len(marks).to_bytes(8, "little") + marks + others


def _changed(
    blob: bytes, base: Connectivity, vertex_ids: np.ndarray, triangle_ids: np.ndarray
) -> np.ndarray:
    """Triangles that are told by others, [T, 3] int32."""
    T, length = len(triangle_ids), int.from_bytes(blob[9:HEAD], "little")
    marks = unpack(blob[HEAD : HEAD + length], "u1", ((T + 7) // 8,))
    kept = np.unpackbits(marks, count=T).astype(bool)
    rows, found = _rows_in(base.triangle_ids, triangle_ids)
    if not (found | ~kept).all():
        raise ValueError("triangles as in a frame that has none such")
    there, is_there = _rows_in(vertex_ids, base.vertex_ids)
    triangles = base.triangles.take(rows, axis=0)
    if not (is_there.all() or is_there.take(triangles[kept]).all()):
        raise ValueError("triangles of vertices that are gone")
    triangles = there.astype(np.int32).take(triangles)
    others = np.flatnonzero(~kept)
    triangles[others] = _unpack_triangles(blob[HEAD + length :], len(others), len(vertex_ids))
    return triangles


def _are_rows(triangles: np.ndarray, count: int) -> bool:
    return bool(triangles.min(initial=0) >= 0 and triangles.max(initial=-1) < count)
