"""What the workers of a cluster run: they say who they are, take a source in, and solve shots."""

import os
import shutil
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from time import monotonic
from typing import Any

from pipeline.loop.ranges import Part, Work
from pipeline.options.output import Output
from pipeline.progress import Progress
from pipeline.track import identity_of
from pipeline.track.identity import SourceIdentity
from pipeline.track.relocate import relocate
from pipeline.version import library_versions, program_version
from stages.media.writing.alone import alone
from warp_kernels.device.memory import is_out_of_memory
from warp_kernels.errors import TrimotionError

OFTEN = 0.5
"""How often frames are told of [s]: each message is work for worker, scheduler and client."""
ORPHANS = 60.0
"""How long to wait for what an earlier run left on the machine [s]."""


@dataclass(frozen=True)
class Errand:
    """What all shots of a run have in common."""

    token: str
    """Names the run: its reports, and a folder for what was sent."""
    source: SourceIdentity
    """The source, and where those who see it have it."""
    mark: Path
    """A file that says that the storage is shared, to those who find the token in it."""
    named: Path
    """What the user calls the source: so the tracks call it, too."""


@dataclass(frozen=True)
class Greeting:
    """What a worker says of itself."""

    versions: dict[str, str]
    """Of the program and the libraries on which the bits depend."""
    threads: int
    """Its threads."""
    shares: bool
    """Whether it sees the source, and the place of the tracks."""


@dataclass(frozen=True)
class Fate:
    """What became of a shot."""

    result: Any = None
    """What the range came to, or None."""
    track: bytes | None = None
    """Its track, where the storage is not shared."""
    error: str = ""
    """Why it failed."""
    exit_code: int = 1
    """The failure's exit code."""
    is_final: bool = True
    """Whether it would fail anywhere."""


class UnwantedError(Exception):
    """Whoever wanted a shot is gone, or wants it no more."""


def greet(errand: Errand, dask_worker: Any) -> Greeting:
    """Say who this worker is.

    Args:
        errand: The run.
        dask_worker: The worker; Dask gives it.
    """
    versions = {"trimotion": program_version(), **library_versions()}
    return Greeting(versions, dask_worker.state.nthreads, _shares(errand))


def receive(errand: Errand, offset: int, content: bytes) -> None:
    """Take in a piece of the source.

    Args:
        errand: The run.
        offset: Where it stands in the file [bytes].
        content: The piece.
    """
    place = _received(errand)
    place.parent.mkdir(exist_ok=True)
    with place.open("r+b" if offset else "wb") as file:
        file.seek(offset)
        file.write(content)


def forget(errand: Errand) -> None:
    """Remove what was sent for a run."""
    shutil.rmtree(_received(errand).parent, ignore_errors=True)


def solve_there(errand: Errand, work: Work, part: Part, shares: bool) -> Fate:
    """Solve a shot on this worker.

    Args:
        errand: The run.
        work: How it is solved; the names of its files are absolute.
        part: The shot and its track.
        shares: Whether the storage is shared.

    Returns:
        What became of it; what fails is told, not raised, for not every error can be sent.
    """
    try:
        report = _Report(errand.token)
        if shares:
            with alone(part.output.track, patience=ORPHANS):
                fate = Fate(_solved(errand, work, part, report))
        else:
            fate = _solved_apart(errand, work, part, report)
        report.send()
        return fate
    except TrimotionError as error:
        return Fate(error=str(error), exit_code=error.exit_code)
    except UnwantedError:
        return Fate(error="stopped", is_final=False)
    except Exception as error:
        short = is_out_of_memory(error)
        text = "out of memory" if short else f"internal error ({type(error).__name__}: {error})"
        return Fate(error=text, is_final=False)


def _solved(errand: Errand, work: Work, part: Part, report: Progress) -> Any:
    result = work.solve(part, report)
    assert part.output.track is not None
    relocate(part.output.track, errand.named)
    return result


def _solved_apart(errand: Errand, work: Work, part: Part, report: Progress) -> Fate:
    """Solve a shot from what was sent, to a track that is sent back."""
    source = _received(errand)
    if not source.is_file():
        return Fate(error="the source did not arrive", is_final=False)
    work = replace(work, options=replace(work.options, source=source))
    with tempfile.TemporaryDirectory(dir=source.parent) as folder:
        track = Path(folder) / "part.mtrk"
        result = _solved(errand, work, Part(part.frames, Output(track=track)), report)
        return Fate(result, track.read_bytes())


def _shares(errand: Errand) -> bool:
    """Whether this worker sees the very source, and the very folder of the tracks."""
    try:
        if errand.mark.read_text() != errand.token:
            return False
        return identity_of(Path(errand.source.path)) == errand.source
    except (OSError, ValueError, TrimotionError):
        return False


def _received(errand: Errand) -> Path:
    """Where the source lies that was sent to this process."""
    folder = Path(tempfile.gettempdir()) / f"trimotion-{errand.token}-{os.getpid()}"
    return folder / f"source{Path(errand.source.path).suffix}"


class _Report(Progress):
    """Tells of frames, and ends the work when nobody wants it any more."""

    def __init__(self, topic: str) -> None:
        super().__init__()
        from distributed import get_worker

        self._topic, self._worker = topic, get_worker()
        self._task = self._worker.get_current_task()
        self._untold: list[tuple[int, float]] = []
        self._told = monotonic()

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Take in that a frame is finished, and tell it from time to time."""
        task = self._worker.state.tasks.get(self._task)
        if task is None or task.state != "executing":
            raise UnwantedError
        self._untold.append((triangles, rmse))
        # the last one at once: whoever finds the shot finished tells of none of its frames
        if done == total or monotonic() - self._told > OFTEN:
            self.send()

    def send(self) -> None:
        """Tell of the frames that were not told yet."""
        if self._untold:
            self._worker.log_event(self._topic, tuple(self._untold))
        self._untold, self._told = [], monotonic()
