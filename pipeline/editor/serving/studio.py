"""One session and the windows that look at it."""

import asyncio
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from pipeline.editor.bench.long_work import LongWork
from pipeline.editor.bench.session import Session
from pipeline.editor.serving.guard import Log
from warp_kernels.errors import OptionError, TrimotionError

if TYPE_CHECKING:
    from pipeline.editor.serving.window import Window

P = ParamSpec("P")
Result = TypeVar("Result")

MOST_WINDOWS = 16
"""Windows that may be open at once."""
LOOK_EVERY = 0.5
"""How often it is looked whether another program went on with the track [s]."""


class Studio:
    """Lets windows work on one session, one thing at a time.

    Args:
        session: What is edited; only the studio's thread touches it from now on.
        log: Told of what goes wrong.
    """

    def __init__(self, session: Session, log: Log) -> None:
        self.session, self.log = session, log
        self._thread = ThreadPoolExecutor(1, "trimotion-editor")
        self._compiler = ThreadPoolExecutor(1, "trimotion-compiler")
        self._windows: set[Window] = set()
        self._number = session.number
        self._work: asyncio.Task[None] | None = None
        self._is_cancelled = threading.Event()
        self._told: dict[str, Any] | None = None

    @property
    def is_full(self) -> bool:
        """Whether no more windows are let in."""
        return len(self._windows) >= MOST_WINDOWS

    @property
    def is_used(self) -> bool:
        """Whether a window is open."""
        return bool(self._windows)

    def enter(self, window: "Window") -> None:
        """A window opens."""
        self._windows.add(window)
        if self._told is not None:
            window.tell(self._told)

    def leave(self, window: "Window") -> None:
        """A window has closed."""
        self._windows.discard(window)

    async def do(self, work: Callable[P, Result], *arguments: P.args, **named: P.kwargs) -> Result:
        """Do something with the session, after all that was asked for before.

        Args:
            work: What is called in the studio's thread.
            arguments: What it is given.
            named: The same.
        """
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._thread, lambda: work(*arguments, **named))

    async def compile_expected(self) -> None:
        """Compile what is missing, while everything else goes on."""
        loop = asyncio.get_running_loop()
        await loop.run_in_executor(self._compiler, self.session.compile_expected)

    async def changed(self) -> None:
        """Show all windows what the job is now."""
        state = await self.do(self.session.state)
        self._number = state["number"]
        for window in list(self._windows):
            window.tell({"tell": "state", **state})
        for window in list(self._windows):
            await window.show_mesh()
        for window in list(self._windows):
            window.want_drawn()

    async def watch(self) -> None:
        """See to it that what another program does with the track is shown; never ends."""
        while True:
            await asyncio.sleep(LOOK_EVERY)
            if self._windows and await self.do(lambda: self.session.number) != self._number:
                await self.changed()

    def begin(self, work: LongWork) -> None:
        """Begin long work, beside which everything else goes on.

        Args:
            work: The work.

        Raises:
            OptionError: If other long work is not done yet.
        """
        if self._work is not None and not self._work.done():
            raise OptionError("one long work at a time; wait for it, or cancel it")
        self._is_cancelled.clear()
        self._work = asyncio.create_task(self._run(work))

    def cancel(self) -> None:
        """End the long work at its next frame."""
        self._is_cancelled.set()

    async def _run(self, work: LongWork) -> None:
        """Do long work, and tell all windows of it."""
        loop = asyncio.get_running_loop()

        def told(done: int, total: int) -> None:
            """A frame is done."""
            loop.call_soon_threadsafe(self._tell_work, work.title, done, total)

        self._tell_work(work.title, 0, 0)
        try:
            notes = await asyncio.to_thread(work.run, told, self._is_cancelled.is_set)
            words = {"tell": "done", "title": work.title, "notes": list(notes)}
        except TrimotionError as error:
            words = {"tell": "failed", "title": work.title, "text": str(error)}
        except Exception as error:  # a mistake of this program must not end the work of a person
            self.log(f"{work.title}: {type(error).__name__}: {error}")
            words = {"tell": "failed", "title": work.title, "text": "that failed"}
        if work.changes:
            await self.do(self.session.renewed)
            await self.changed()
        self._tell_all(words)

    def _tell_work(self, title: str, done: int, total: int) -> None:
        self._tell_all({"tell": "work", "title": title, "done": done, "total": total})

    def _tell_all(self, words: dict[str, Any]) -> None:
        self._told = words if words["tell"] == "work" else None
        for window in self._windows:
            window.tell(words)

    def close(self) -> None:
        """Let what was begun end, and release the session."""
        self._is_cancelled.set()
        self._thread.submit(self.session.close).result()
        self._thread.shutdown()
        self._compiler.shutdown(cancel_futures=True)

    def facts(self) -> dict[str, Any]:
        """What a window is told when it opens."""
        from pipeline.editor.wire.facts import facts_of

        return facts_of(self.session)
