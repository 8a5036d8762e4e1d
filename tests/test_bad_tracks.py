"""A track is input from strangers: whatever is wrong with one, a command ends with one line."""

import os
import sqlite3
import subprocess
import sys
import tracemalloc
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from pipeline.cli import main
from pipeline.track import TrackReader
from pipeline.track.plain_values import UnknownNameError, from_plain, to_plain
from pipeline.track.schema import open_existing
from stages.layouts.importance import Importance
from stages.validate import InvalidMeshError, assert_finite, assert_sound, assert_valid
from tests.bad_tracks import NAMES, bomb, copy_of, discard, map_of, plant
from tests.meshes import HEIGHT, WIDTH, random_mesh
from tests.tracks import QUICK_FLAGS, solve_to, write_clip

COUNT = 200
"""Planted tracks."""
QUIET = ("--progress", "none")
MOST_MEMORY = 200
"""Megabytes that a bad track may cost beyond what a good one does."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A clip, a track of its beginning, one of its going on, and what is drawn of the first."""
    folder = tmp_path_factory.mktemp("bad")
    clip = write_clip(folder / "in.mp4")
    solve_to(folder / "good.mtrk", clip, "0-3")
    solve_to(folder / "rest.mtrk", clip, "4-5")
    drawn = ["-o", str(folder / "out.mkv"), "--codec", "ffv1", *QUIET]
    assert main(["render", str(folder / "good.mtrk"), *drawn]) == 0
    return folder


def commands(folder: Path, bad: Path) -> list[tuple[object, ...]]:
    """Everything that reads a track."""
    clip, beside = folder / "in.mp4", bad.parent
    going_on = ("--resume", "--frames", "0-5", *QUICK_FLAGS, *QUIET)
    return [
        ("info", bad),
        ("render", bad, "-o", beside / "a.mp4", *QUIET),
        ("animate", clip, "-o", beside / "a.mp4", "--track", bad, *going_on),
        ("solve", clip, "-o", bad, *going_on),
        ("join", bad, folder / "rest.mtrk", "-o", beside / "a.mtrk"),
        ("measure", clip, folder / "out.mkv", "--frames", "0-3", "--track", bad, *QUIET),
    ]


WRITING = (2, 3)
"""Those of them that write one as well."""


@pytest.mark.parametrize("tenth", range(10))
def test_bad_track_is_one_line(tenth: int, folder: Path, capsys) -> None:
    """Exit code 3 and the file's name, and nothing is written.

    Each damage meets one of the commands here, another one when its turn comes again.
    """
    for number in range(tenth, COUNT, 10):
        bad = copy_of(folder / "good.mtrk", folder, number)
        turn = (number + number // len(NAMES)) % 6
        if NAMES[number % len(NAMES)] == "folder" and turn in WRITING:
            discard(bad)  # no bad track: a new one is written into it
            continue
        command = commands(folder, bad)[turn]
        code = main([*map(str, command)])
        captured = capsys.readouterr()
        case = (number, NAMES[number % len(NAMES)], command[0], code, captured.err)
        assert (code, captured.out, captured.err.count("\n")) == (3, "", 1), case
        assert captured.err.startswith(f"trimotion: error: {bad}: "), case
        left = {path.name for path in bad.parent.iterdir()} - {"bad.mtrk", "bad.mtrk-journal"}
        assert not left, case
        discard(bad)


GREEDY = ("frame of bombs", "map of a bomb", "fact is long", "blob is a bomb", "fact is deep")
PROCESS = """
import resource, sys
from pipeline.cli import main
good, *bad = sys.argv[1:]
assert main(["info", good]) == 0
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
for path in bad:
    assert main(["info", path]) == 3, path
after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print((after - before) // 1024)
"""


def test_bombs_cost_little_memory(folder: Path, tmp_path: Path) -> None:
    """In a process of its own, which neither crashes nor grows; 100 MB are packed in each."""
    pytest.importorskip("resource")
    numbers = [NAMES.index(name) + turn * len(NAMES) for name in GREEDY for turn in range(2)]
    paths = [copy_of(folder / "good.mtrk", tmp_path, number) for number in numbers]
    ended = subprocess.run(
        [sys.executable, "-c", PROCESS, str(folder / "good.mtrk"), *map(str, paths)],
        capture_output=True,
        text=True,
        timeout=120,
        env={**os.environ, "PYTHONPATH": os.getcwd()},
    )
    assert ended.returncode == 0, ended.stderr
    assert ended.stderr.count("\n") == len(paths)
    assert "Traceback" not in ended.stderr
    assert int(ended.stdout.split()[-1]) < MOST_MEMORY


def test_a_file_commands_nothing(folder: Path, tmp_path: Path) -> None:
    """A connection takes no long statement, no second file, no deep expression and no function of
    a schema that does anything."""
    path = tmp_path / "copy.mtrk"
    path.write_bytes((folder / "good.mtrk").read_bytes())
    with closing(open_existing(path)) as connection:
        assert connection.execute("PRAGMA trusted_schema").fetchone() == (0,)
        assert connection.execute("PRAGMA cell_size_check").fetchone() == (1,)
        deep = "(" * 100 + "1" + "+1)" * 100
        many = " UNION ".join(["SELECT 1"] * 100)
        for statement in (f"SELECT {deep}", many, f"SELECT 1 -- {'x' * 200_000}"):
            with pytest.raises(sqlite3.Error):
                connection.execute(statement)
        connection.execute("ATTACH ':memory:' AS part")  # as join does
        with pytest.raises(sqlite3.Error, match="too many attached"):
            connection.execute("ATTACH ':memory:' AS other")


def test_good_tracks_pass(folder: Path) -> None:
    """The checks of what is read, and the thorough one of what is edited."""
    with TrackReader(folder / "good.mtrk") as track:
        track.check()
        assert len(track.rows) == 4
        for row in track.rows:
            snapshot = track.snapshot(row.frame)
            assert_finite(snapshot)
            assert_valid(snapshot.mesh)


def test_damage_is_the_same_every_time(folder: Path, tmp_path: Path) -> None:
    """A number stands for one damage, so that what it finds can be looked at again."""
    paths = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        paths.append(copy_of(folder / "good.mtrk", tmp_path / name, 17))
    assert paths[0].read_bytes() == paths[1].read_bytes()
    assert plant(paths[0], 17 + len(NAMES)) == NAMES[17]


def test_arrays_are_no_larger_than_they_say() -> None:
    """A map that unpacks to more than its shape ends there; one without arrays is not unpacked."""
    layout = {"class": "Importance", "importance_map": map_of([4, 4], "<f8", bomb(64))}
    tracemalloc.start()
    with pytest.raises(ValueError, match="importance_map"):
        from_plain(Importance, layout)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 1 << 20
    assert from_plain(Importance, layout, arrays=False).importance_map is None


@pytest.mark.parametrize("size", [(WIDTH + 1, HEIGHT), (WIDTH, HEIGHT + 1), (2 * WIDTH, HEIGHT)])
def test_mesh_of_another_picture_is_told(size: tuple[int, int]) -> None:
    """All is in order with it, but a part of the picture is uncovered: a column is enough."""
    mesh = random_mesh(1)
    assert_sound(mesh)
    with pytest.raises(InvalidMeshError, match="over a picture"):
        assert_sound(replace(mesh, width=size[0], height=size[1]))


@pytest.mark.parametrize("change", [{"class": "Popen"}, {"telepathy": 1}])
def test_unknown_names_are_told(change: dict[str, object]) -> None:
    """A class or a field of another program is named, not guessed at."""
    with pytest.raises(UnknownNameError, match=r"Popen|telepathy"):
        from_plain(Importance, {**to_plain(Importance()), **change})


NO_NUMBERS = """
from dataclasses import replace
import numpy as np
from stages.render import Renderer
from tests.kernel_samples import noise, random_mesh
from tests.kernel_samples import snapshot_of
from warp_kernels.color_model import CONSTANT
from warp_kernels.device.device import Device
from warp_kernels.styles import STYLES
mesh = random_mesh(96, 64, 40)
device = Device("cpu", 2)
good = snapshot_of(device, noise(96, 64), mesh, CONSTANT)
for style in STYLES.values():
    renderer = Renderer(device, (96, 64), (96, 64), (style(),))
    for value in (np.nan, np.inf, 1e300, -1e6):
        vertices = mesh.vertices.copy()
        vertices[::3] = value
        bad = replace(good, mesh=mesh.moved(vertices))
        bad = replace(bad, coefficients=np.where(good.energies[:, None, None] > 0, value, 0.0))
        with np.errstate(all="ignore"):
            renderer.render(bad, source=noise(96, 64))
"""


def test_kernels_look_nowhere_else() -> None:
    """Whatever a mesh says, no style reads memory that is not its own: the process lives."""
    ended = subprocess.run(
        [sys.executable, "-c", NO_NUMBERS],
        capture_output=True,
        text=True,
        timeout=300,
        env={**os.environ, "PYTHONPATH": os.getcwd()},
    )
    assert ended.returncode == 0, (ended.returncode, ended.stderr[-2000:])
