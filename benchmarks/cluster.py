"""What a Dask cluster adds to the work: 12 shots by one process, then by 1, 2 and 3 workers.

    python benchmarks/cluster.py [--frames 10] [--workers 1 2 3]

All have one thread. Wall time tells something only on an idle machine with a core for each; CPU
time says what the work costs wherever it runs. The longest worker's CPU time is what the wall time
would be on cores of their own, so `efficiency` is that of one process, divided by it and by the
workers.
"""

import argparse
import resource
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.farm.cluster.address import SPARING
from pipeline.farm.cluster.runner import OnCluster
from pipeline.loop.animate import solve
from pipeline.loop.ranges import InThisProcess, RangeRunner
from pipeline.loop.result import Animated
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import TrackReader
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions

SHOTS = 12
SIZE = (320, 180)


class InTurn(InThisProcess):
    """One process that solves shot after shot, each to a track of its own, as workers do."""

    places = 2


class Watched(OnCluster):
    """Knows what client and scheduler took of this process, without cuts and joining."""

    used = 0.0

    def run(self, *given: Any) -> Sequence[Animated]:
        """Solve ranges beside each other."""
        begun = cpu()
        try:
            return super().run(*given)
        finally:
            self.used = cpu() - begun


def film(folder: Path, frames: int) -> SolveOptions:
    """A film of shots of noise that drifts, and the list of its cuts."""
    import av

    rng = np.random.default_rng(7)
    width, height = SIZE
    path = folder / "film.mkv"
    with av.open(str(path), "w") as output:
        stream = output.add_stream("ffv1", rate=25)
        stream.width, stream.height, stream.pix_fmt = width, height, "bgr0"
        for _ in range(SHOTS):
            field = rng.random((12, 20, 3))
            large = np.kron(field, np.ones((24, 24, 1))) * 255
            for n in range(frames):
                pixels = large[2 * n : 2 * n + height, 3 * n : 3 * n + width].astype(np.uint8)
                frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(pixels), "rgb24")
                output.mux(stream.encode(frame.reformat(format="bgr0")))
        output.mux(stream.encode())
    cuts = folder / "cuts"
    cuts.write_text("\n".join(str(frames * shot) for shot in range(1, SHOTS)))
    options = TriangulateOptions(refine=RefineOptions(triangles=800))
    return SolveOptions(path, cuts=str(cuts), triangulate=options)


def cpu() -> float:
    """CPU time of this process and of its children that have ended [s]."""
    own, past = (
        resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    )
    return own.ru_utime + own.ru_stime + past.ru_utime + past.ru_stime


def run(options: SolveOptions, track: Path, runner: RangeRunner) -> tuple[float, float]:
    """Wall time and this process's CPU time of a run [s]."""
    begun, used = time.perf_counter(), cpu()
    solve(options, Output(track=track), Run(threads=1), Progress(), runner=runner)
    return time.perf_counter() - begun, cpu() - used


def rows(track: Path) -> list[bytes]:
    """What of a track must be equal."""
    with TrackReader(track) as reader:
        return [
            reader.snapshot(row.frame).mesh.vertices.tobytes()
            + reader.snapshot(row.frame).coefficients.tobytes()
            for row in reader.rows
        ]


def used_by(dask_worker: object) -> float:
    """CPU time of a worker so far [s]."""
    return time.process_time()


def main() -> int:
    """Print a line a number of workers."""
    parser = argparse.ArgumentParser(description="Measure what a cluster adds.")
    parser.add_argument("--frames", type=int, default=10, help="of a shot")
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2, 3])
    given = parser.parse_args()
    import dask
    from distributed import Client, LocalCluster

    dask.config.set(SPARING)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        options = film(folder, given.frames)
        run(options, folder / "warm.mtrk", InTurn())
        wall, alone = run(options, folder / "alone.mtrk", InTurn())
        expected = rows(folder / "alone.mtrk")
        print(f"one process: {wall:.1f} s, CPU {alone:.1f} s, {SHOTS} shots", flush=True)
        for count in given.workers:
            with (
                LocalCluster(
                    n_workers=count,
                    threads_per_worker=1,
                    processes=True,
                    memory_limit=0,
                    dashboard_address=None,
                ) as cluster,
                Client(cluster, set_as_default=False) as client,
            ):
                address = cluster.scheduler_address
                run(options, folder / f"first{count}.mtrk", OnCluster(address))  # they import
                before = client.run(used_by)
                track = folder / f"{count}.mtrk"
                runner = Watched(address)
                wall, _ = run(options, track, runner)
                here = runner.used
                after = client.run(used_by)
            spent = [after[worker] - before[worker] for worker in before]
            assert rows(track) == expected
            print(
                f"{count} workers: {wall:.1f} s, CPU of the workers "
                f"{' + '.join(f'{s:.1f}' for s in spent)} s, of client and scheduler {here:.2f} s "
                f"({1000 * here / SHOTS:.0f} ms a shot), efficiency "
                f"{alone / (count * max(spent)):.2f}",
                flush=True,
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
