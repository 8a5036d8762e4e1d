"""Long random logs of edits by hand: valid after each, undone and replayed to the bit.

    python -m benchmarks.edit_logs [--edits N] [--seeds N] [--first SEED]
                                   [--clip CLIP] [--frames A-B]

Stills first: a log of so many edits of one mesh. Then a clip: a log of so many edits over all its
frames. They are looked at one by one, and solved twice, the second time from the log's lines on one
thread. Without edits it is what a plain run makes. Some random edits cannot be made: what is told
of them is counted.
"""

import argparse
import re
import sqlite3
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from time import perf_counter, process_time
from unittest.mock import patch

import numpy as np

from pipeline.edit_log.json_lines import as_json_lines, from_json_lines
from pipeline.loop.animate import solve
from pipeline.options.edit_log import EditLog, Replayed
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import TrackReader
from stages.hand import Edit
from stages.hand.worked import Worked
from stages.layouts.importance import Importance
from stages.media import FrameRange, probe
from stages.mesh import Mesh
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions
from stages.validate import assert_valid
from tests.random_edits import random_edit

SIZE = (640, 360)
TRIANGLES = 1500
CLIP = Path(__file__).parents[1] / "sample_videos" / "shapes.mp4"
QUICK = TriangulateOptions(frame_iterations=12, refine=RefineOptions(triangles=400))
"""What is asked here does not depend on how well a picture is met."""

MOST_TOLD = 70
"""Letters by which reasons are told apart."""


@contextmanager
def watched_edits() -> Iterator[set[int]]:
    """Look at the mesh after each edit of all solving while the block runs.

    Yields:
        Numbers of the edits that were made.
    """
    made: set[int] = set()
    plain = EditLog.steps

    def steps(log: EditLog, frame: int, worked: Worked) -> Iterator[tuple[int, Replayed]]:
        """Make the edits of a frame, and check what each leaves."""
        for number, step in plain(log, frame, worked):
            assert_valid(step.worked.mesh)
            if not step.refused:
                made.add(number)
            yield number, step

    # real need: a track stores the log by its class, which therefore cannot be another one
    with patch.object(EditLog, "steps", steps):
        yield made


def same(one: Mesh, other: Mesh) -> bool:
    """Whether two meshes are equal to the bit."""
    names = ("vertices", "triangles", "vertex_ids", "triangle_ids")
    return all(np.array_equal(getattr(one, n), getattr(other, n)) for n in names)


def first_mesh(seed: int) -> Mesh:
    """A layout over noise."""
    rng = np.random.default_rng(seed)
    pixels = rng.integers(0, 255, (SIZE[1], SIZE[0], 3)).astype(np.uint8)
    return Importance().build(pixels, TRIANGLES, rng)


def check_still(seed: int, count: int) -> None:
    """Make one log of edits of a mesh and check it."""
    rng = np.random.default_rng([1, seed])
    worked = Worked(first_mesh(seed))
    made: list[Edit] = []
    refused = 0
    seconds = 0.0
    told: list[str] = []
    while len(made) < count:
        edit = random_edit(rng, SIZE)
        begun = process_time()
        result = EditLog((edit,)).replay(0, worked)
        seconds += process_time() - begun
        refused += len(result.refused)
        if result.refused:
            told += result.refused
            assert result.worked is worked
            continue
        worked = result.worked
        made.append(edit)
        assert_valid(worked.mesh)
    log = from_json_lines(as_json_lines(EditLog(tuple(made))), "log")
    undone = EditLog(()).replay(0, Worked(first_mesh(seed))).worked
    replayed = log.replay(0, Worked(first_mesh(seed))).worked
    print(
        f"still, seed {seed}: {count} edits made, {refused} refused, "
        f"{1e3 * seconds / count:.1f} ms of CPU each; {worked.mesh.triangle_count} triangles, "
        f"{len(worked.locks.vertices)} held vertices; "
        f"undone to the bit: {same(undone.mesh, first_mesh(seed))}, "
        f"replayed to the bit: {same(replayed.mesh, worked.mesh)}"
    )
    _print_kinds(told)


def check_clip(clip: Path, frames: FrameRange, seed: int, count: int) -> None:
    """Make one log of edits over the frames of a clip, and check it."""
    rng = np.random.default_rng([2, seed])
    info = probe(clip)
    assert frames.last is not None
    numbers = rng.integers(frames.first, frames.last + 1, count).tolist()
    edits = tuple(random_edit(rng, (info.width, info.height), number) for number in numbers)
    log = EditLog(edits)
    with tempfile.TemporaryDirectory() as folder:
        plain, first, again, none = (Path(folder) / f"{n}.mtrk" for n in ("p", "f", "a", "n"))
        with watched_edits() as made:
            told, seconds = _solved(clip, frames, log, first)
        _solved(clip, frames, from_json_lines(as_json_lines(log), "log"), again, threads=1)
        _solved(clip, frames, EditLog(), none)
        _solved(clip, frames, None, plain)
        with TrackReader(first) as track:
            for row in track.rows:
                assert_valid(track.snapshot(row.frame).mesh)
        print(
            f"clip, seed {seed}: {count} edits in {len(log.frames)} frames, {len(made)} "
            f"made, {len(told)} warnings, {seconds:.0f} s; the mesh is valid after each edit and "
            f"in all {len(_rows(first))} frames, undone to the bit: "
            f"{_rows(none) == _rows(plain)}, replayed to the bit: {_rows(again) == _rows(first)}"
        )
        _print_kinds(told)


def _print_kinds(told: Sequence[str]) -> None:
    """Print what is told of edits that cannot be made: their reasons, without numbers."""
    reasons = (text.rpartition("left out: ")[2] for text in told)
    kinds = Counter(re.sub(r"-?[0-9][0-9.e-]*", "#", text)[:MOST_TOLD] for text in reasons)
    for kind, count in kinds.most_common():
        print(f"  {count:5d}  {kind}", flush=True)


def _solved(
    clip: Path, frames: FrameRange, log: EditLog | None, track: Path, threads: int = 0
) -> tuple[tuple[str, ...], float]:
    """Solve a clip to a track; what was told of edits, and the time [s]."""
    options = SolveOptions(clip, frames, triangulate=QUICK, edits=log)
    begun = perf_counter()
    result = solve(options, Output(track=track), Run(threads=threads), Progress())
    return result.warnings, perf_counter() - begun


def _rows(track: Path) -> list[tuple[object, ...]]:
    """All that is stored of the frames of a track."""
    with closing(sqlite3.connect(track)) as connection:
        query = "SELECT * FROM meshes LEFT JOIN topologies USING (frame) ORDER BY frame"
        return connection.execute(query).fetchall()


def main() -> None:
    """Run all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--edits", type=int, default=2000)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--clip", type=Path, default=CLIP)
    parser.add_argument("--frames", default="0-23")
    given = parser.parse_args()
    for seed in range(given.first, given.first + given.seeds):
        check_still(seed, given.edits)
    for seed in range(given.first, given.first + given.seeds):
        check_clip(given.clip, FrameRange.parse(given.frames), seed, given.edits)


if __name__ == "__main__":
    main()
