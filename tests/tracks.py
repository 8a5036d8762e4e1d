"""A small clip of two shots and what is compared of tracks made from it."""

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

from pipeline.loop.animate import solve
from pipeline.loop.ranges import InThisProcess
from pipeline.loop.result import Animated
from pipeline.progress import Progress
from pipeline.track.schema import TABLES
from stages.media import FrameRange
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions
from tests import media_samples as samples
from tests.jobs import job_of

CUT, COUNT = 6, 12
"""First frame of the second shot, and number of frames."""
QUICK = TriangulateOptions(iterations=8, frame_iterations=4, refine=RefineOptions(triangles=40))
QUICK_FLAGS = ("--iterations", "8", "--frame-iterations", "4", "--triangles", "40")


def write_clip(path: Path) -> Path:
    """A moving square, then its negative upside down; 96 x 64, with sound."""
    first = [samples.picture(96, 64, number) for number in range(CUT)]
    second = [255 - samples.picture(96, 64, number)[::-1] for number in range(COUNT - CUT)]
    return samples.write_video(path, first + second, sound=1)


def solve_to(
    track: Path, clip: Path, frames: str = "0-", progress: Progress | None = None, **options: Any
) -> Animated:
    """Solve a range of a clip to a track, on one thread: tests run side by side."""
    wanted = {"frame_range": FrameRange.parse(frames), "triangulate": QUICK, "threads": 1}
    wanted |= options
    job = job_of(clip, track=track, **wanted)
    return solve(job.solve, job.output, job.run, progress or Progress())


class InTurn(InThisProcess):
    """Solves ranges one by one, and looks for shots as if it had room for many at once."""

    places = 9


def rows_of(track: Path) -> dict[str, list[tuple]]:
    """All rows of all frames, blobs included; by a path of its own, without the reader."""
    with closing(sqlite3.connect(track)) as connection:
        names = connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")
        known = {name for (name,) in names}
        return {
            table: connection.execute(f"SELECT * FROM {table} ORDER BY frame").fetchall()
            for table in TABLES
            if table in known
        }
