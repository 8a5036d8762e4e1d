"""The threads of a device: they replay what was captured, in step."""

from collections.abc import Sequence
from functools import partial
from threading import Lock, Thread
from typing import Any

import warp as wp

from warp_kernels.device.barrier import address_of_sleep, meet
from warp_kernels.device.launcher import Graph, Launcher
from warp_kernels.device.phase import Phase
from warp_kernels.device.runtime import WARP

PART = "trimotion-part"
"""Name of the threads."""


class Team:
    """The calling thread and others beside it that replay captured phases in step.

    Args:
        size: Threads, the calling one included.
        launcher: Records and captures launches.
        flags: Counters of the threads, [(size + 1) * STRIDE] int on the device.
    """

    def __init__(self, size: int, launcher: Launcher, flags: wp.array) -> None:
        self._size = size
        self._launcher = launcher
        self._flags = flags
        self._job: tuple[list[Any], int] = ([], 0)
        self._meetings: list[Any] = []
        self._abandoned = False
        self._busy = [Lock() for _ in range(size)]
        self._starts = [_closed_lock() for _ in range(size)]
        self._threads = [
            Thread(target=partial(_replay_forever, self, number), daemon=True, name=PART)
            for number in range(1, size)
        ]
        for thread in self._threads:
            thread.start()

    def run(self, phases: Sequence[Phase], times: int) -> None:
        """Replay phases `times` times over, the parts of each phase at once."""
        self._job = (self._graphs_of(phases), times)
        for start in self._starts[1:]:
            start.release()
        self.replay(0)

    def replay(self, number: int) -> None:
        """Do one thread's part of the job; the last phase ends with a meeting as well."""
        graphs, times = self._job
        with self._busy[number]:
            for _ in range(times):
                if self._abandoned:
                    return
                graphs[number]()

    def wait_for_start(self, number: int) -> bool:
        """Sleep until there is a job for a thread; whether the team goes on."""
        self._starts[number].acquire()
        return not self._abandoned

    def dismiss(self) -> None:
        """Let the threads end that have nothing to do; the team is not used again.

        Calls nothing of Warp: the interpreter may come here on any thread, at any moment.
        """
        self._abandoned = True
        for start in self._starts[1:]:
            if start.locked():
                start.release()

    def abandon(self) -> None:
        """Let nobody wait any more, and wait until nobody works; then threads end."""
        self.dismiss()
        with WARP:
            self._flags.fill_(1)
        for busy in self._busy:
            busy.acquire()
            busy.release()

    def join(self) -> None:
        """Wait until the threads of a dismissed team have ended."""
        for thread in self._threads:
            thread.join()

    def _graphs_of(self, phases: Sequence[Phase]) -> list[Graph]:
        """What the threads replay; kept by the first phase, for as long as that is kept."""
        first, *others = phases
        key = (self, first.shape, *((id(phase), phase.shape) for phase in others))
        if key not in first.sequences:
            if self._size > 1 and not self._meetings:
                self._meetings = self._recorded_meetings()
            graphs = [self._capture(phases, number) for number in range(self._size)]
            first.sequences[key] = (graphs, others)  # they must outlive their ids
        graphs, _ = first.sequences[key]
        return graphs

    def _recorded_meetings(self) -> list[Any]:
        """The launch with which each thread waits for the others."""
        pause = address_of_sleep()
        return [
            self._launcher.record(meet, [number, self._size, pause, self._flags])
            for number in range(self._size)
        ]

    def _capture(self, phases: Sequence[Phase], number: int) -> Graph:
        """What one thread replays: its parts that are not empty, and where it waits."""
        launches = []
        for phase in phases:
            part = phase.parts[number]
            if part.bounds.size > 0:
                launches.append(part)
            if self._meetings and not (phase.flows_on and phase is not phases[-1]):
                launches.append(self._meetings[number])
        return self._launcher.capture(launches)


def _replay_forever(team: Team, number: int) -> None:
    while team.wait_for_start(number):
        team.replay(number)


def _closed_lock() -> Lock:
    lock = Lock()
    lock.acquire()
    return lock
