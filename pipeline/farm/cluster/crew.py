"""Who of a cluster works on which shot: each on one at a time, and on another one after that."""

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from queue import Empty, Queue
from time import monotonic
from typing import Any

from pipeline.farm.cluster.worker import (
    Errand,
    Fate,
    Greeting,
    forget,
    greet,
    receive,
    solve_there,
)
from pipeline.loop.ranges import Part, Work
from pipeline.loop.result import Animated
from pipeline.progress import Progress
from pipeline.version import library_versions, program_version
from stages.media import input_pattern
from stages.media.writing.commit import PendingFile
from warp_kernels.errors import OptionError, TrimotionError

WAIT = 0.5
"""How long to wait for news at a time [s]."""
LOOK = 2.0
"""How often it is asked who is there [s]; whose shot is lost is told without asking."""
ATTEMPTS = 3
"""How often a shot is tried whose workers are lost or fail for reasons of their own."""
LONGEST_WAIT = 60.0
"""How long to wait for a first worker, or another one when all are gone [s]."""
PIECE = 1 << 24
"""Bytes of the source that are sent at once."""


class ClusterError(TrimotionError):
    """A failure on a cluster.

    Args:
        text: What is told of it.
        exit_code: Its exit code.
    """

    def __init__(self, text: str, exit_code: int = 1) -> None:
        super().__init__(text)
        self.exit_code = exit_code


@dataclass(frozen=True)
class _Try:
    """A shot that a worker is at."""

    number: int
    """Its number."""
    worker: str
    """The worker's address."""
    future: Any
    """What Dask has of it."""


class Crew:
    """The workers of a cluster, as they come and go, and the shots that are left.

    Args:
        client: Reaches the cluster.
        errand: What all shots have in common.
        work: How they are solved.
        parts: The shots and their tracks.
    """

    def __init__(self, client: Any, errand: Errand, work: Work, parts: Sequence[Part]) -> None:
        self._client, self._errand, self._work, self._parts = client, errand, work, parts
        spans = [(part.frames.last or 0) - part.frames.first for part in parts]
        order = sorted(range(len(parts)), key=lambda number: -spans[number])
        self._left = deque(order)
        self._tries = [0] * len(parts)
        self._known: dict[str, tuple[str, Greeting]] = {}  # who they are, by address
        self._busy: dict[str, _Try] = {}  # by address
        self._events: Queue[Any] = Queue()
        self._found: dict[int, Animated] = {}
        self._looked = self._seen = monotonic()

    @contextmanager
    def at_work(self) -> Iterator[None]:
        """Listen to the workers; however the block ends, nobody goes on."""
        self._client.subscribe_topic(self._errand.token, self._events.put)
        try:
            yield
        finally:
            for one in self._busy.values():
                with suppress(Exception):  # whoever is gone has stopped
                    one.future.cancel(force=True)
            strangers = self._strangers()
            if strangers:
                with suppress(Exception):
                    self._client.run(forget, self._errand, workers=strangers, on_error="ignore")

    def results(self, progress: Progress) -> Mapping[int, Animated]:
        """Let all shots be solved; what each came to, by its number.

        Args:
            progress: Told of every frame.

        Raises:
            ClusterError: If a shot cannot be solved, or nobody is left to do it.
            OptionError: If workers have other versions.
        """
        with self._scheduled():
            self._look_around()
        while len(self._found) < len(self._parts):
            with self._scheduled():
                self._hand_out()
            try:
                event = self._events.get(timeout=WAIT)
            except Empty:
                event = None
            if isinstance(event, tuple):  # (time, what a worker reports)
                for triangles, rmse in event[1]:
                    progress.frame(0, None, triangles, rmse)
            elif event is not None:
                with self._scheduled():
                    self._take_in(event)
            if monotonic() - self._looked > LOOK:
                with self._scheduled():
                    self._look_around()
        return self._found

    @contextmanager
    def _scheduled(self) -> Iterator[None]:
        """Say so if the scheduler is gone; Dask has many errors for that, some without a name."""
        try:
            yield
        except TrimotionError:
            raise
        except Exception as error:
            lost = isinstance(error, OSError) and error.errno is None  # a connection's
            if self._client.status == "running" and not lost:
                raise
            raise ClusterError(
                "the scheduler is gone; start one, with workers, and go on with --resume"
            ) from error

    def _hand_out(self) -> None:
        """Give everybody something to do."""
        for address, (_, greeting) in self._known.items():
            if not self._left:
                return
            if address in self._busy:
                continue
            number = self._left.popleft()
            threads = self._work.run.threads or greeting.threads
            run = replace(self._work.run, threads=threads, jobs=1, cluster=None)
            self._tries[number] += 1
            future = self._client.submit(
                solve_there,
                self._errand,
                replace(self._work, run=run),
                self._parts[number],
                greeting.shares,
                key=f"trimotion-{self._errand.token}-{number}-{self._tries[number]}",
                workers=[address],
                pure=False,
                retries=0,
            )
            self._busy[address] = _Try(number, address, future)
            future.add_done_callback(self._events.put)

    def _take_in(self, future: Any) -> None:
        """What became of a shot."""
        one = next((one for one in self._busy.values() if one.future is future), None)
        if one is None:
            return  # of a worker that was given up
        del self._busy[one.worker]
        outcome = self._outcome(one)
        if outcome is None:
            self._again(one.number, f"worker {one.worker} lost it")
            return
        if outcome.result is None:
            if outcome.is_final:
                raise ClusterError(outcome.error, outcome.exit_code)
            self._again(one.number, f"{outcome.error} on worker {one.worker}")
            return
        if outcome.track is not None:
            _write(self._parts[one.number], outcome.track)
        self._found[one.number] = outcome.result

    def _outcome(self, one: _Try) -> Fate | None:
        """What a worker made of a shot, None if it is lost.

        A worker that is gone before its answer was fetched takes that along: Dask would wait for
        one of the same address, and for ever.
        """
        while one.future.status == "finished":
            try:
                found: Fate = one.future.result(timeout=LOOK)
            except TimeoutError:
                if one.worker not in self._client.run_on_scheduler(_present):
                    one.future.cancel(force=True)
                    return None
            except Exception:  # whatever it was, the shot is to be done again
                return None
            else:
                return found
        return None

    def _again(self, number: int, reason: str) -> None:
        """Put a shot back, in front."""
        if self._tries[number] >= ATTEMPTS:
            raise ClusterError(
                f"frames {self._parts[number].frames} failed {ATTEMPTS} times on the cluster "
                f"({reason}); go on with --resume, and --jobs 1 --debug to see why"
            )
        self._left.appendleft(number)

    def _look_around(self) -> None:
        """See who came and who is gone."""
        self._looked = monotonic()
        present = self._client.run_on_scheduler(_present)
        for address, (identity, _) in list(self._known.items()):
            if present.get(address) != identity:
                del self._known[address]
                one = self._busy.pop(address, None)
                if one is not None:
                    one.future.cancel(force=True)
                    self._again(one.number, f"worker {address} is gone")
        new = {address: who for address, who in present.items() if address not in self._known}
        if new:
            self._welcome(new)
        if self._known:
            self._seen = monotonic()
        elif monotonic() - self._seen > LONGEST_WAIT:
            raise ClusterError(
                f"no worker for {LONGEST_WAIT:.0f} s; start some with dask worker, and go on with "
                "--resume"
            )

    def _welcome(self, new: Mapping[str, str]) -> None:
        """Take workers in: they must be the same program, and get the source if they lack it."""
        told = self._client.run(greet, self._errand, workers=list(new), on_error="return")
        greetings = {address: one for address, one in told.items() if isinstance(one, Greeting)}
        for address, one in told.items():
            if address in greetings:
                _check_versions(address, one)
            elif not isinstance(one, OSError):  # which says that it went meanwhile
                raise OptionError(
                    f"worker {address}: does not know this program ({one}); install trimotion "
                    f"{program_version()} there"
                )
        strangers = [address for address, one in greetings.items() if not one.shares]
        if strangers:
            self._send_source(strangers)
        self._known |= {address: (new[address], one) for address, one in greetings.items()}

    def _send_source(self, workers: list[str]) -> None:
        """Send the source to workers that cannot see it."""
        path = Path(self._errand.source.path)
        if input_pattern(path) is not None:
            raise OptionError(
                f"{path}: workers {', '.join(workers)} do not see these stills, and only one file "
                "can be sent; put them where all workers find them under the same name"
            )
        with path.open("rb") as file:
            offset = 0
            while content := file.read(PIECE):
                self._client.run(receive, self._errand, offset, content, workers=workers)
                offset += len(content)

    def _strangers(self) -> list[str]:
        return [address for address, (_, one) in self._known.items() if not one.shares]


def _present(dask_scheduler: Any) -> dict[str, str]:
    """Who is there: identities by address; asked on the scheduler."""
    return {
        address: str(state.server_id)
        for address, state in dask_scheduler.workers.items()
        if state.status.name == "running"
    }


def _check_versions(address: str, greeting: Greeting) -> None:
    """Refuse a worker whose bits would be others."""
    mine = {"trimotion": program_version(), **library_versions()}
    differing = [
        f"{name} {greeting.versions.get(name, 'none')} instead of {version}"
        for name, version in mine.items()
        if greeting.versions.get(name) != version
    ]
    if differing:
        raise OptionError(
            f"worker {address}: has {', '.join(differing)}; install the same versions there, for "
            "the same bits"
        )


def _write(part: Part, track: bytes) -> None:
    """Put a track that was sent into its place."""
    assert part.output.track is not None
    pending = PendingFile(part.output.track)
    pending.path.write_bytes(track)
    pending.commit()
