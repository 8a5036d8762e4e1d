"""Shots on a Dask cluster: a real scheduler and three workers, processes that can be killed."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from pipeline.cli import main
from pipeline.farm.cluster.crew import ClusterError, Crew, _check_versions
from pipeline.farm.cluster.runner import OnCluster
from pipeline.farm.cluster.worker import Errand, Greeting
from pipeline.loop.animate import solve
from pipeline.loop.ranges import Part, Work
from pipeline.progress import Progress
from pipeline.track import TrackReader, identity_of
from pipeline.version import library_versions, program_version
from stages.media import FrameRange
from tests import media_samples as samples
from tests.jobs import job_of
from tests.tracks import QUICK, rows_of
from warp_kernels.errors import OptionError

ROOT = Path(__file__).parents[1]
SHOTS, LENGTH = 8, 4
"""Shots of the film, and frames of each."""
distributed = pytest.importorskip("distributed", reason="Dask is not installed")


@pytest.fixture(scope="module")
def film(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A film of several shots, and beside it the list of their first frames."""
    folder = tmp_path_factory.mktemp("cluster")
    shots = [
        (255 - samples.picture(96, 64, n))[:: 1 - 2 * (shot % 2)] ^ (31 * shot)
        for shot in range(SHOTS)
        for n in range(LENGTH)
    ]
    (folder / "cuts").write_text("\n".join(str(LENGTH * shot) for shot in range(1, SHOTS)))
    return samples.write_video(folder / "film.mp4", shots)


@pytest.fixture(scope="module")
def whole(film: Path) -> dict:
    """The rows of one run."""
    solve_film(film, film.with_name("whole.mtrk"))
    return rows_of(film.with_name("whole.mtrk"))


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mapping[str, object]]:
    """A scheduler's file, and the processes of the workers; the second one is slow."""
    folder = tmp_path_factory.mktemp("dask")
    file = folder / "scheduler.json"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "dask"]
    more = ["--scheduler-file", file, "--no-dashboard"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder}
    started = [
        subprocess.Popen([*command, "scheduler", "--port", "0", *more], env=environment, **quiet)
    ]
    workers = [
        subprocess.Popen(
            [*before, *command, "worker", *more, "--nthreads", "1", "--no-nanny"],
            env=environment,
            **quiet,
        )
        for before in ([], ["nice", "-n", "5"], [])
    ]
    try:
        yield {"file": str(file), "workers": workers}
    finally:
        for process in [*workers, *started]:
            process.kill()
            process.wait()


def solve_film(film: Path, track: Path, runner=None, progress=None, **options):
    """Solve the film."""
    job = job_of(
        film, track=track, triangulate=QUICK, cuts=str(film.with_name("cuts")), threads=1, **options
    )
    return solve(job.solve, job.output, job.run, progress or Progress(), runner=runner)


class Killing(Progress):
    """Kills a process at some frame."""

    def __init__(self, process: subprocess.Popen, at: int) -> None:
        super().__init__()
        self.process, self.at, self.told = process, at, 0

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Count, and kill."""
        assert total == SHOTS * LENGTH
        self.told += 1
        if self.told == self.at:
            self.process.send_signal(signal.SIGKILL)


class Ending(Progress):
    """Ctrl-C at the third frame."""

    told = 0

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Count, and interrupt."""
        self.told += 1
        if self.told == 3:
            raise KeyboardInterrupt


def wait_for(cluster: Mapping, count: int) -> None:
    """Wait until so many workers are there."""
    with distributed.Client(scheduler_file=cluster["file"], set_as_default=False) as client:
        client.wait_for_workers(count, timeout=300)


def test_three_workers_one_killed_one_slow(
    film: Path, whole: dict, cluster: Mapping, tmp_path: Path
) -> None:
    """The same bits; what was sent gives the same; then one dies, and its shot alone is redone."""
    wait_for(cluster, 3)
    track = tmp_path / "t.mtrk"
    with pytest.raises(KeyboardInterrupt):
        solve_film(film, track, OnCluster(cluster["file"]), Ending())
    assert not track.exists()
    assert not list(tmp_path.rglob("*.mark"))
    found = solve_film(film, track, OnCluster(cluster["file"]), resume=True)
    assert found.frames <= SHOTS * LENGTH - 2  # what was solved before is not solved again
    assert rows_of(track) == whole

    sent = tmp_path / "sent.mtrk"
    solve_film(film, sent, OnCluster(cluster["file"], streams=True))
    assert rows_of(sent) == whole
    with TrackReader(sent) as reader, TrackReader(film.with_name("whole.mtrk")) as once:
        assert reader.header == once.header

    killed, progress = tmp_path / "killed.mtrk", Killing(cluster["workers"][0], at=8)
    solve_film(film, killed, OnCluster(cluster["file"]), progress)
    assert cluster["workers"][0].wait() == -signal.SIGKILL
    assert rows_of(killed) == whole
    # who dies takes along what it had not told, and its shot is gone on with, not begun anew
    assert SHOTS * LENGTH - LENGTH < progress.told <= SHOTS * LENGTH + LENGTH


def test_command(film: Path, whole: dict, cluster: Mapping, tmp_path: Path, capsys) -> None:
    """By its address; a failure of a worker is one line with its code."""
    wait_for(cluster, 2)
    with distributed.Client(scheduler_file=cluster["file"], set_as_default=False) as client:
        address = client.scheduler.address
    options = ["--iterations", "8", "--frame-iterations", "4", "--triangles", "40"]
    options += ["--cuts", str(film.with_name("cuts")), "--cluster", address]
    track = tmp_path / "c.mtrk"
    assert main(["solve", str(film), "-o", str(track), *options]) == 0
    assert rows_of(track) == whole
    assert f"{SHOTS * LENGTH} frames" in capsys.readouterr().err
    options += ["--device", "cuda:99"]
    assert main(["solve", str(film), "-o", str(tmp_path / "d.mtrk"), *options, "-q"]) == 2
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert "cuda:99" in captured.err


class Unreachable:
    """A client whose scheduler is gone: some calls fail by what is lost, others anyhow."""

    def __init__(self, status: str, error: Exception) -> None:
        self.status, self.error = status, error

    def run_on_scheduler(self, _: object) -> None:
        """Fail."""
        raise self.error


@pytest.mark.parametrize(
    ("status", "error", "raised"),
    [
        ("running", distributed.comm.CommClosedError("ConnectionPool closing."), ClusterError),
        ("closed", RuntimeError("IOLoop is closed"), ClusterError),
        ("running", RuntimeError("a fault of the program"), RuntimeError),
        ("running", FileNotFoundError(2, "no such file"), FileNotFoundError),
    ],
    ids=["lost", "closed", "fault", "file"],
)
def test_a_scheduler_that_is_gone_is_told(
    status: str, error: Exception, raised: type[Exception], film: Path, tmp_path: Path
) -> None:
    """And how to go on; faults of another kind stay what they are."""
    job = job_of(film, track=tmp_path / "t.mtrk", triangulate=QUICK)
    part = Part(FrameRange(0, 3), job.output)
    errand = Errand("token", identity_of(film), tmp_path / "token.mark", film)
    work = Work(job.solve, job.run, job.fitted)
    with pytest.raises(raised) as found:
        Crew(Unreachable(status, error), errand, work, [part]).results(Progress())
    told = "the scheduler is gone" in str(found.value) and "--resume" in str(found.value)
    assert told == (raised is ClusterError)


def test_other_versions_are_refused() -> None:
    """By the name of the worker and of what differs."""
    mine = {"trimotion": program_version(), **library_versions()}
    _check_versions("tcp://a:1", Greeting(mine, 1, True))
    with pytest.raises(OptionError, match=r"tcp://a:1: has numpy 1\.0 instead of"):
        _check_versions("tcp://a:1", Greeting({**mine, "numpy": "1.0"}, 1, True))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--cluster", "local:0"], "local:N"),
        (["--cluster", "local:2", "--jobs", "2"], "leave --jobs out"),
    ],
)
def test_mistakes_are_one_line(options: list[str], message: str, film: Path, capsys) -> None:
    """Before anything starts."""
    assert main(["solve", str(film), "-o", "t.mtrk", *options]) == 2
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert message in captured.err


def test_nothing_answers(film: Path, tmp_path: Path, capsys) -> None:
    """A wrong address is one line."""
    options = ["--cuts", str(film.with_name("cuts")), "--cluster", "tcp//nowhere"]
    assert main(["solve", str(film), "-o", str(tmp_path / "t.mtrk"), *options, "-q"]) == 1
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert "nothing answers there" in captured.err
