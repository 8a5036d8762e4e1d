"""Tracks that a stranger could send: good ones, each with one thing wrong, by a number.

A plant changes a copy of a good track so that no command may take it; what it does besides its
kind (which frame, which corner, which value) is drawn from the number.
"""

import base64
import json
import shutil
import sqlite3
import zlib
from collections.abc import Callable
from contextlib import closing, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from pipeline.track import TrackReader
from pipeline.track.packing.plain import pack
from pipeline.track.packing.topologies import BY_ANOTHER
from pipeline.track.packing.whole_numbers import pack_whole

Plant = Callable[[sqlite3.Connection, np.random.Generator], None]
FilePlant = Callable[[Path, np.random.Generator], None]

KINDS = {
    "vertices": "<f8",
    "coefficients": "<f8",
    "energies": "<f8",
    "counts": "<i8",
    "triangles": "<i4",
    "vertex_ids": "<i8",
    "triangle_ids": "<i8",
}
"""Columns of blobs and the types of their numbers."""
NO_NUMBERS = (np.nan, np.inf, -np.inf)


def table_of(column: str) -> str:
    """The table that holds blobs of a name."""
    return "topologies" if column in ("triangles", "vertex_ids", "triangle_ids") else "meshes"


def frames_with(connection: sqlite3.Connection, table: str) -> list[int]:
    """The frames that have a row in a table."""
    return [row[0] for row in connection.execute(f"SELECT frame FROM {table} ORDER BY frame")]


def some_frame(connection: sqlite3.Connection, rng: np.random.Generator, table: str) -> int:
    """One of them."""
    return int(rng.choice(frames_with(connection, table)))


def numbers_of(connection: sqlite3.Connection, frame: int, column: str) -> np.ndarray:
    """What a frame's blob holds, in one row."""
    ((_, _, path), *_) = connection.execute("PRAGMA database_list").fetchall()
    with TrackReader(Path(path)) as track:
        snapshot = track.snapshot(frame)
    owner = snapshot if hasattr(snapshot, column) else snapshot.mesh
    return getattr(owner, column).astype(KINDS[column]).reshape(-1).copy()


def rewrite(
    column: str, change: Callable[[np.ndarray, np.random.Generator], np.ndarray | None]
) -> Plant:
    """A plant that changes the numbers of one frame's blob, packed plainly."""

    def plant(connection: sqlite3.Connection, rng: np.random.Generator) -> None:
        table = table_of(column)
        frame = some_frame(connection, rng, table)
        numbers = numbers_of(connection, frame, column)
        changed = change(numbers, rng)
        packed = pack(numbers if changed is None else changed, KINDS[column])
        connection.execute(f"UPDATE {table} SET {column} = ? WHERE frame = ?", (packed, frame))

    return plant


def one(*values: float) -> Callable[[np.ndarray, np.random.Generator], None]:
    """Put one of some values in place of any number."""

    def change(numbers: np.ndarray, rng: np.random.Generator) -> None:
        numbers[rng.integers(len(numbers))] = rng.choice(values)

    return change


def put(column: str, make: Callable[[bytes, np.random.Generator], Any]) -> Plant:
    """A plant that puts something else in place of one frame's blob."""

    def plant(connection: sqlite3.Connection, rng: np.random.Generator) -> None:
        table = table_of(column)
        frame = some_frame(connection, rng, table)
        query = f"SELECT {column} FROM {table} WHERE frame = ?"
        (blob,) = connection.execute(query, (frame,)).fetchone()
        value = make(blob, rng)
        connection.execute(f"UPDATE {table} SET {column} = ? WHERE frame = ?", (value, frame))

    return plant


def cell(column: str, *values: Any) -> Plant:
    """A plant that puts one of some values into a column of `frames`."""

    def plant(connection: sqlite3.Connection, rng: np.random.Generator) -> None:
        frame = some_frame(connection, rng, "frames")
        value = values[rng.integers(len(values))]
        connection.execute(f"UPDATE frames SET {column} = ? WHERE frame = ?", (value, frame))

    return plant


def execute(*statements: str) -> Plant:
    """A plant that is one of some statements of SQL, or several with a semicolon."""

    def plant(connection: sqlite3.Connection, rng: np.random.Generator) -> None:
        connection.executescript(statements[rng.integers(len(statements))])

    return plant


def fact(key: str, *path: str, values: tuple[Any, ...]) -> Plant:
    """A plant that puts one of some values at a place of the header."""

    def plant(connection: sqlite3.Connection, rng: np.random.Generator) -> None:
        query = "SELECT value FROM header WHERE key = ?"
        content = json.loads(connection.execute(query, (key,)).fetchone()[0])
        value = values[rng.integers(len(values))]
        place = content
        for name in path[:-1]:
            place = place[name]
        if path:
            place[path[-1]] = value
        text = json.dumps(content if path else value)
        connection.execute("UPDATE header SET value = ? WHERE key = ?", (text, key))

    return plant


def text(key: str, *values: Any) -> Plant:
    """A plant that puts one of some texts in place of a field of the header."""

    def plant(connection: sqlite3.Connection, rng: np.random.Generator) -> None:
        value = values[rng.integers(len(values))]
        connection.execute("UPDATE header SET value = ? WHERE key = ?", (value, key))

    return plant


def exchanged(vertices: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Positions with those inside of the picture in another order: triangles fold, but together
    they still cover as much as before."""
    points = vertices.reshape(-1, 2)
    low, high = points.min(axis=0), points.max(axis=0)
    inside = np.flatnonzero(((points > low) & (points < high)).all(axis=1))
    points[inside] = points[np.roll(inside, 1 + rng.integers(len(inside) - 1))]
    return points


@lru_cache
def bomb(megabytes: int) -> bytes:
    """Zeros, packed a thousand times smaller."""
    machine = zlib.compressobj(9)
    block = bytes(1 << 20)
    parts = [machine.compress(block) for _ in range(megabytes)]
    return b"".join(parts) + machine.flush()


def bombed_frame(connection: sqlite3.Connection, rng: np.random.Generator) -> None:
    """A frame that says that it has as many triangles as its bomb unpacks to."""
    frame = some_frame(connection, rng, "topologies")
    T = int(rng.choice([1 << 20, (1 << 20) + 1, 1 << 24, 1 << 40]))
    update = "UPDATE frames SET vertex_count = ?, triangle_count = ? WHERE topology = ?"
    connection.execute(update, (T // 2 + 2, T, frame))
    for column in ("vertex_ids", "triangle_ids"):
        packed = bomb(8) if rng.random() < 0.5 else pack(np.arange(1 << 20), "<i8")
        connection.execute(f"UPDATE topologies SET {column} = ? WHERE frame = ?", (packed, frame))


def by(frame: int) -> bytes:
    """Triangles that are said to be those of another frame, one of 40 excepted."""
    marks = pack(np.packbits(np.arange(40) > 0), "u1")
    head = bytes([BY_ANOTHER]) + int(frame).to_bytes(8, "little", signed=True)
    return head + len(marks).to_bytes(8, "little") + marks + pack_whole(np.array([[0], [1], [2]]))


def map_of(shape: list[int], kind: str, content: bytes) -> dict[str, Any]:
    """An importance map as a header holds it."""
    return {"dtype": kind, "shape": shape, "data": base64.b64encode(content).decode()}


def foreign_table(columns: str) -> str:
    """SQL that gives `frames` other columns."""
    return (
        f"ALTER TABLE frames RENAME TO old; CREATE TABLE frames ({columns});"
        "INSERT INTO frames SELECT * FROM old; DROP TABLE old;"
    )


ENDLESS = (
    "DROP TABLE frames; CREATE VIEW frames AS WITH RECURSIVE n(i) AS "
    "(SELECT 0 UNION ALL SELECT i + 1 FROM n) SELECT i AS frame, i AS pts, 0 AS shot, 0 AS "
    "topology, 5 AS vertex_count, 4 AS triangle_count, 9 AS next_vertex_id, 9 AS "
    "next_triangle_id, 1.0 AS rmse FROM n"
)
INFO = ("info",)
LAYOUT = ("options", "layout")
SHUFFLED = {
    name: rewrite(name, lambda numbers, rng: rng.permutation(numbers))
    for name in ("vertices", "triangles", "vertex_ids")
}

PLANTS: dict[str, Plant] = {
    "vertex is no number": rewrite("vertices", one(*NO_NUMBERS)),
    "vertex far outside": rewrite("vertices", one(1e300, -1e9, 1e6, 8193.0)),
    "vertex beside the picture": rewrite("vertices", one(-0.001, 96.5, -np.pi)),
    "vertices in one place": rewrite("vertices", lambda v, rng: 0 * v + rng.random()),
    "vertices shuffled": SHUFFLED["vertices"],
    "vertices exchanged": rewrite("vertices", exchanged),
    "corner of no vertex": rewrite("triangles", one(-1, 10**6, 2**31 - 1, -(2**31))),
    "corners in one place": rewrite("triangles", lambda t, rng: 0 * t + rng.integers(5)),
    "triangle turned round": rewrite("triangles", lambda t, rng: t[::-1]),
    "triangles shuffled": SHUFFLED["triangles"],
    "vertex numbers twice": rewrite("vertex_ids", lambda n, rng: np.maximum(n, n[3])),
    "vertex numbers shuffled": SHUFFLED["vertex_ids"],
    "vertex number impossible": rewrite("vertex_ids", one(-1, 2**62, -(2**63))),
    "triangle numbers fall": rewrite("triangle_ids", lambda n, rng: n[::-1]),
    "triangle numbers equal": rewrite("triangle_ids", lambda n, rng: 0 * n),
    "triangle number impossible": rewrite("triangle_ids", one(-5, 2**63 - 1)),
    "colour is no number": rewrite("coefficients", one(*NO_NUMBERS, 1e300)),
    "error is no number": rewrite("energies", one(*NO_NUMBERS, -1.0, 1e200)),
    "count below zero": rewrite("counts", one(-1, -(2**63))),
    "too few numbers": rewrite("energies", lambda e, rng: e[:-1]),
    "too many numbers": rewrite("vertices", lambda v, rng: np.tile(v, 40)),
    "blob cut off": put("coefficients", lambda b, rng: b[: rng.integers(len(b))]),
    "blob of noise": put("triangles", lambda b, rng: rng.bytes(len(b))),
    "blob with a hole": put("vertices", lambda b, rng: b[:9] + b"\0" * 9 + b[18:]),
    "blob is empty": put("counts", lambda b, rng: b""),
    "blob is text": put("vertices", lambda b, rng: "vertices"),
    "blob is a number": put("triangle_ids", lambda b, rng: int(rng.integers(99))),
    "blob is a bomb": put("energies", lambda b, rng: bomb(100)),
    "whole numbers are a bomb": put("coefficients", lambda b, rng: b[:1] + bomb(100)),
    "whole numbers of other widths": put("coefficients", lambda b, rng: bytes([b[0] + 1]) + b[1:]),
    "whole numbers are too few": put("energies", lambda b, rng: pack_whole(np.arange(7))),
    "whole numbers are huge": put(
        "counts", lambda b, rng: pack_whole(np.full(40, -(2 ** rng.integers(1, 54))))
    ),
    "triangles by a frame that is not": put("triangles", lambda b, rng: by(rng.integers(9, 99))),
    "triangles by no frame": put("triangles", lambda b, rng: by(-rng.integers(1, 99))),
    "triangles by themselves": execute(
        *(
            f"UPDATE topologies SET triangles = X'{BY_ANOTHER:x}{frame:02x}' || zeroblob(29)"
            f" WHERE frame = {frame}"
            for frame in (0, 1)
        )
    ),
    "blob of zeros": put("vertex_ids", lambda b, rng: zlib.compress(bytes(4096))),
    "frame of bombs": bombed_frame,
    "frame number is text": cell("pts", "soon", b"soon", 1.5),
    "time impossible": cell("pts", 2**62, -(2**62)),
    "times in disorder": execute("UPDATE frames SET pts = -pts", "UPDATE frames SET pts = 0"),
    "shot is text": cell("shot", "first", 0.5),
    "shot after its frame": cell("shot", 99, 2**40),
    "shot below zero": cell("shot", -1, -(2**62)),
    "shots in disorder": execute(
        "UPDATE frames SET shot = 2 WHERE frame > 1; UPDATE frames SET shot = 0 WHERE frame = 3",
        "UPDATE frames SET shot = 1 WHERE frame = 3",
    ),
    "topology of no frame": cell("topology", 77, -1),
    "topology is text": cell("topology", "mine", b"mine"),
    "size is text": cell("triangle_count", "many", b"\1", 3.5),
    "size below zero": cell("triangle_count", -4, 0, -(2**63)),
    "size is huge": cell("triangle_count", 10**6, 2**31, 2**62),
    "vertices below zero": cell("vertex_count", -1, 0, 2),
    "vertices are huge": cell("vertex_count", 2**31, 2**62, 41),
    "vertices are text": cell("vertex_count", "all", b"", 4.5),
    "free number is text": cell("next_vertex_id", "next", 7.5),
    "free number in use": cell("next_triangle_id", 1, 0, -9),
    "free number is huge": cell("next_vertex_id", 2**63 - 1, 2**61),
    "rmse is no number": cell("rmse", 9e999, "low", -1.0, b"0"),
    "frames that do not exist": execute(
        *(
            f"UPDATE {table} SET frame = frame + 1000" + more
            for table, more in (("frames", ""), ("frames", ", shot = shot + 1000"))
        ),
        "UPDATE frames SET frame = -3 WHERE frame = 0",
        "UPDATE frames SET frame = 9223372036854775807 WHERE frame = 3",
    ),
    "frame is missing": execute("DELETE FROM frames WHERE frame = 1"),
    "mesh is missing": execute("DELETE FROM meshes WHERE frame = 3", "DELETE FROM meshes"),
    "topology is missing": execute("DELETE FROM topologies"),
    "no table": execute(
        "DROP TABLE header", "DROP TABLE frames", "DROP TABLE meshes", "DROP TABLE topologies"
    ),
    "endless view": execute(ENDLESS),
    "trigger": execute(
        "CREATE TRIGGER t BEFORE INSERT ON frames BEGIN DELETE FROM frames; END",
        "CREATE TRIGGER t AFTER UPDATE ON header BEGIN DELETE FROM meshes; END",
    ),
    "another table": execute("CREATE TABLE secrets (x)", "CREATE INDEX i ON frames (pts)"),
    "other columns": execute(
        foreign_table("frame, pts, shot, topology, vertex_count, triangle_count, n, m, rmse"),
        "ALTER TABLE meshes ADD COLUMN more",
        "ALTER TABLE frames RENAME COLUMN pts TO times",
    ),
    "computed column": execute(
        "ALTER TABLE frames ADD COLUMN x AS (hex(zeroblob(99999999))) VIRTUAL"
    ),
    "fact is missing": execute(
        *(
            f"DELETE FROM header WHERE key = '{key}'"
            for key in ("program", "libraries", "options", "source", "info", "model", "finished")
        )
    ),
    "fact of another kind": text("options", "[]", "7", "null", '"all"', "true", "[[]]"),
    "fact is no JSON": text("info", "", "{", "yes", '{"a": NaN}', "\x00", "'a'"),
    "fact is a blob": text("source", b"\xff\xfe", b"{}", 7, 1.5),
    "fact is deep": text("libraries", "[" * 100_000, '{"a":' * 50_000),
    "fact is long": text("libraries", "[" + "[]," * 3_000_000 + "0]"),
    "fact of broken text": execute(
        "UPDATE header SET value = CAST(X'FFFEFD' AS TEXT) WHERE key = 'program'"
    ),
    "fact of no program": execute("INSERT INTO header VALUES ('soul', '1')"),
    "program is no text": fact("program", values=(7, None, ["0.1"], {})),
    "libraries are none": fact("libraries", values=(7, ["numpy"], {"numpy": 1}, "numpy")),
    "model is unknown": fact("model", values=("cubic", 7, None, ["constant"])),
    "finished is text": fact("finished", values=("no", 1, None)),
    "width impossible": fact("info", "width", values=(0, -96, 8193, 10**9, 96.0, "96", None, True)),
    "height of another picture": fact("info", "height", values=(1, 63, 65, 8192)),
    "time base impossible": fact(
        "info", "time_base", values=("0", "1/0", "-1", "1e999999999", "soon", 1, None, "9" * 99)
    ),
    "aspect impossible": fact("info", "sample_aspect", values=("0", "-1/2", "1/99999999999", [])),
    "rate impossible": fact("info", "average_rate", values=("0", "-25", "nan", 25)),
    "counts impossible": fact("info", "frame_count", values=(-1, "12", 2**40, 1.5)),
    "kind is unknown": fact("info", "kind", values=("hologram", 7, None)),
    "turned by anything": fact("info", "rotation", values=(45, -90, 10**30, "90")),
    "notes are none": fact("info", "notes", values=("a note", [7], {"a": 1})),
    "source without a name": fact("source", "path", values=(7, None, "a\0b", ["in.mp4"])),
    "source of no size": fact("source", "size", values=("big", None, 1.5)),
    "foreign layout": fact(*LAYOUT, "class", values=("Popen", "object", 7, None, "__import__")),
    "foreign flow": fact("options", "flow", values=({"class": "Evil"}, {}, "dis", None, 7)),
    "foreign style": fact("options", "styles", values=([{"class": "Neon"}], "flat", {"a": 1}, [7])),
    "foreign job": fact("options", "class", values=("System", 7, None)),
    "foreign option": fact("options", "telepathy", values=(True, 7, "on")),
    "foreign setting": fact("options", "triangulate", "refine", "magic", values=(1, None)),
    "number is text": fact("options", "seed", values=("0", 1.5, None, [0], True, -1)),
    "text is a number": fact("options", "triangulate", "color", values=(1, None, "cubic", [])),
    "number is none": fact("options", "smooth", values=(1e999, "1", None, 1e9)),
    "choice impossible": fact(
        "options", "triangulate", "refine", "triangles", values=(-5, 0, 1, "40", None)
    ),
    "area impossible": fact(
        "options", "triangulate", "refine", "max_area", values=(8.0, -1.0, "x")
    ),
    "range impossible": fact("options", "frame_range", "first", values=(-1, 1, 99, "0", None, 0.5)),
    "range ends before": fact("options", "frame_range", "last", values=(-1, 0, 1, "3", 2.0)),
    "step impossible": fact("options", "frame_range", "step", values=(0, -1, 2, "1", None)),
    "cuts are a file": fact("options", "cuts", values=("/etc/passwd", 7, None, ["a"], [-1], [[]])),
    "map of objects": fact(
        *LAYOUT, "importance_map", values=(map_of([1], "|O", b""), map_of([2], "<V9", b""), 7, [])
    ),
    "map of a bomb": fact(
        *LAYOUT,
        "importance_map",
        values=(map_of([20_000, 26_843], "<f8", bomb(40)), map_of([2**40], "|u1", bomb(1))),
    ),
    "map of no shape": fact(
        *LAYOUT,
        "importance_map",
        values=(
            map_of([-1, 4], "<f8", b""),
            map_of([2] * 40, "<f8", b""),
            {**map_of([2], "<f8", b""), "shape": "2x2"},
            {"dtype": "<f8"},
        ),
    ),
}
"""What can be wrong inside of a file that SQLite takes."""


def overwrite(path: Path, rng: np.random.Generator, value: int) -> None:
    """Fill a whole page of the file, but not the one that holds the form of the tables."""
    content = bytearray(path.read_bytes())
    page = int.from_bytes(content[16:18], "big")
    first = page * int(rng.integers(1, len(content) // page))
    content[first : first + page] = bytes([value]) * page
    path.write_bytes(content)


def shorten(path: Path, rng: np.random.Generator) -> None:
    """End anywhere."""
    content = path.read_bytes()
    path.write_bytes(content[: rng.integers(len(content) - 1)])


def replace_by_folder(path: Path, rng: np.random.Generator) -> None:
    """A folder of that name, perhaps with the track in it."""
    content = path.read_bytes()
    path.unlink()
    path.mkdir()
    if rng.random() < 0.5:
        (path / "inside.mtrk").write_bytes(content)


def replace_by_picture(path: Path, rng: np.random.Generator) -> None:
    """A picture under a track's name."""
    encoded = cv2.imencode(".png", rng.integers(0, 255, (20, 30, 3), dtype=np.uint8))[1]
    path.write_bytes(encoded.tobytes())


def number_at(place: int, *values: int) -> FilePlant:
    """Put a number of four bytes at a place of the file."""

    def plant(path: Path, rng: np.random.Generator) -> None:
        content = bytearray(path.read_bytes())
        content[place : place + 4] = int(rng.choice(values)).to_bytes(4, "big")
        path.write_bytes(content)

    return plant


FILES: dict[str, FilePlant] = {
    "empty": lambda path, rng: path.write_bytes(b""),
    "text": lambda path, rng: path.write_text("a track, believe me\n" * 99),
    "noise": lambda path, rng: path.write_bytes(rng.bytes(9000)),
    "noise behind the name": lambda path, rng: path.write_bytes(
        path.read_bytes()[:100] + rng.bytes(9000)
    ),
    "name alone": lambda path, rng: path.write_bytes(path.read_bytes()[: rng.integers(16, 101)]),
    "folder": replace_by_folder,
    "picture": replace_by_picture,
    "cut off": shorten,
    "page of ones": lambda path, rng: overwrite(path, rng, 255),
    "page of zeros": lambda path, rng: overwrite(path, rng, 0),
    "another program's": number_at(68, 0, 7),
    "another format": number_at(60, 0, 2, 99),
    "pages of another size": number_at(16, 0x02000101, 0x00010101, 0x40000101),
}
"""What can be wrong with a file."""
NAMES = (*PLANTS, *FILES)
"""All kinds of damage."""


def plant(path: Path, number: int) -> str:
    """Damage a good track.

    Args:
        path: The track; changed in place.
        number: Which damage: as many in a row as there are kinds are all different.

    Returns:
        What is wrong with it now.
    """
    name = NAMES[number % len(NAMES)]
    rng = np.random.default_rng([1826, number])
    if name in FILES:
        FILES[name](path, rng)
    else:
        with closing(sqlite3.connect(path, isolation_level=None)) as connection:
            PLANTS[name](connection, rng)
    return name


def copy_of(track: Path, folder: Path, number: int) -> Path:
    """A damaged copy of a good track, in a folder of its own."""
    folder = folder / f"{number:03d}"
    folder.mkdir()
    path = Path(shutil.copy(track, folder / "bad.mtrk"))
    plant(path, number)
    return path


def discard(path: Path) -> None:
    """Remove such a copy and what was left beside it."""
    with suppress(OSError):
        shutil.rmtree(path.parent)
