"""Tracks of format 1, whose numbers all stand there plainly: read, joined and gone on with."""

import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pipeline.track import TrackReader
from pipeline.track.join import join
from pipeline.track.packing.plain import pack
from stages.snapshot import Snapshot
from tests.tracks import CUT, QUICK, solve_to, write_clip


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The clip."""
    return write_clip(tmp_path_factory.mktemp("old") / "in.mp4")


def as_of_old(track: Path) -> Path:
    """A track as the first format tells it."""
    with TrackReader(track) as reader:
        found = [reader.snapshot(row.frame) for row in reader.rows]
    with closing(sqlite3.connect(track, isolation_level=None)) as connection:
        connection.execute("PRAGMA user_version = 1")
        for snapshot in found:
            mesh, frame = snapshot.mesh, snapshot.frame_index
            plain = (
                *(pack(mesh.vertices, "<f8"), pack(snapshot.coefficients, "<f8")),
                *(pack(snapshot.energies, "<f8"), pack(snapshot.counts, "<i8"), frame),
            )
            connection.execute(
                "UPDATE meshes SET vertices = ?, coefficients = ?, energies = ?, counts = ?"
                " WHERE frame = ?",
                plain,
            )
            plain = (
                *(pack(mesh.triangles, "<i4"), pack(mesh.vertex_ids, "<i8")),
                *(pack(mesh.triangle_ids, "<i8"), frame),
            )
            connection.execute(
                "UPDATE topologies SET triangles = ?, vertex_ids = ?, triangle_ids = ?"
                " WHERE frame = ?",
                plain,
            )
            if snapshot.limits is not None:
                values = (pack(snapshot.limits, "u1"), frame)
                connection.execute("UPDATE limits SET limits = ? WHERE frame = ?", values)
    return track


def same(one: Snapshot, other: Snapshot) -> bool:
    """Whether two snapshots are one, to the bit."""
    names = ("coefficients", "energies", "counts", "limits")
    pairs = [(getattr(one, name), getattr(other, name)) for name in names]
    names = ("vertices", "triangles", "vertex_ids", "triangle_ids")
    pairs += [(getattr(one.mesh, name), getattr(other.mesh, name)) for name in names]
    return all(
        a is b or (np.array_equal(a, b) and (a.dtype, a.tobytes()) == (b.dtype, b.tobytes()))
        for a, b in pairs
    )


def whole_and_parts(folder: Path, clip: Path, color: str) -> tuple[Path, list[Path]]:
    """A track, one of an old program that ends early, and one of its rest."""
    options = {"triangulate": replace(QUICK, color=color)}
    paths = [folder / f"{name}.mtrk" for name in ("whole", "old", "rest")]
    for path, frames in zip(paths, ("0-8", "0-3", "4-8"), strict=True):
        solve_to(path, clip, frames, **options)
    as_of_old(paths[1])
    return paths[0], paths[1:]


@pytest.mark.parametrize("color", ["constant", "linear"])
def test_old_tracks_are_read_and_go_on(color: str, clip: Path, tmp_path: Path) -> None:
    """To the bits of one that is new from the first frame on; rows of both kinds lie side by side,
    in a track that is joined as well."""
    whole, (old, rest) = whole_and_parts(tmp_path, clip, color)
    joined = tmp_path / "joined.mtrk"
    join([old, rest], joined)
    options = {"triangulate": replace(QUICK, color=color)}
    with TrackReader(whole) as reader:
        wanted = [reader.snapshot(frame) for frame in range(9)]
    with TrackReader(old) as reader:
        assert all(same(reader.snapshot(frame), wanted[frame]) for frame in range(4))
    solve_to(old, clip, "0-8", resume=True, **options)
    for path, frames in ((old, range(9)), (joined, range(4))):
        with TrackReader(path) as reader:
            assert all(same(reader.snapshot(frame), wanted[frame]) for frame in frames)
            assert len(reader.rows) == 9
        with closing(sqlite3.connect(path)) as connection:
            assert connection.execute("PRAGMA user_version").fetchone() == (2,)
    assert CUT < 8  # the track goes on over the beginning of a shot
