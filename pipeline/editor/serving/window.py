"""One window of a browser: what it asks for in turn, and what it is told."""

import asyncio
import json
from collections.abc import Mapping
from contextlib import suppress
from time import monotonic
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from pipeline.editor.bench.easel import MOST_ACROSS, look_of
from pipeline.editor.bench.live import Live
from pipeline.editor.bench.session import EDITED, LIVE
from pipeline.editor.bench.sketch import Sketch
from pipeline.editor.serving.answers import ANSWERS
from pipeline.editor.serving.guard import shown
from pipeline.editor.serving.pace import Pace
from pipeline.editor.serving.studio import Studio
from pipeline.editor.wire.asked import Asked, AskError, read_asked
from pipeline.editor.wire.facts import strokes_told
from pipeline.editor.wire.packed import packed_mesh, packed_pixels, packed_work
from pipeline.options.look import Look
from warp_kernels.errors import TrimotionError

TOO_BIG, POLICY, TRY_LATER = 1009, 1008, 1013
"""Codes with which a connection is closed."""
LULL = 4.0
"""While the optimiser works, so much longer than drawing took nothing is drawn: it shall work."""


class Window:
    """A window that looks at a frame.

    Args:
        socket: Its connection, not yet accepted.
        studio: What it works in.
    """

    def __init__(self, socket: WebSocket, studio: Studio) -> None:
        self._socket, self.studio = socket, studio
        self.frame = studio.session.film.frames[0]
        self.look: Look = look_of(())
        self.styles: list[str] = []
        self.sketch: Sketch | None = None
        self.view = EDITED
        self._words: list[str] = []
        self._pictures: dict[str, bytes] = {}  # the newest of each kind: who is slow misses some
        self._news = asyncio.Event()
        self._undrawn = asyncio.Event()
        self._course: Mapping[str, float] = {}
        self._steps = 0
        self._running = asyncio.Event()
        self._is_drawn, self._draws_at = True, 0.0
        self._pace = Pace()

    async def run(self) -> None:
        """Serve the window until it closes."""
        await self._socket.accept()
        if self.studio.is_full:
            await self._socket.close(TRY_LATER, "too many windows are open; close one")
            return
        self.studio.enter(self)
        beside = [asyncio.create_task(one) for one in (self._send(), self._draw(), self._live())]
        try:
            await self._listen()
        except WebSocketDisconnect as gone:
            if gone.code == TOO_BIG:
                self.studio.log("refused a message that is too long; its window was closed")
        finally:
            self.studio.leave(self)
            for task in beside:
                task.cancel()

    def tell(self, words: Mapping[str, Any]) -> None:
        """Tell something, in its turn."""
        self._words.append(json.dumps(words))
        self._news.set()

    def show(self, kind: str, packed: bytes) -> None:
        """Show something in place of what was of that kind.

        Args:
            kind: What it is.
            packed: The message.
        """
        self._pictures[kind] = packed
        self._news.set()

    async def show_picture(self) -> None:
        """Show the source's picture of the frame."""
        frame = self.frame
        picture = await self.studio.do(self.studio.session.picture, frame)
        self.show("picture", packed_pixels({"kind": "picture", "frame": frame}, picture.pixels))

    async def show_mesh(self) -> None:
        """Show the mesh of the frame."""
        frame, view = self.frame, self.view
        self.show("mesh", await self.studio.do(self._mesh, frame, view))
        strokes = await self.studio.do(self.studio.session.focus, frame, view)
        self.tell({"tell": "focus", "frame": frame, "strokes": strokes_told(strokes)})

    def want_drawn(self) -> None:
        """Have the frame drawn, soon: of what is asked for meanwhile the last counts."""
        self._undrawn.set()

    async def show_drawn(self, *, at_once: bool = False, across: int = MOST_ACROSS) -> None:
        """Show the frame as the film shows it.

        Args:
            at_once: Whether who asks waits: where kernels have to be compiled it is shown later.
            across: Widest picture [px].
        """
        frame, look = self.frame, self.look
        session = self.studio.session
        if self.sketch is not None:
            look = await self.studio.do(session.under, look, self.sketch)
        if await self.studio.do(session.prepare, look, across):
            if at_once:
                self.want_drawn()
                return
            self.tell({"tell": "preparing", "is": True})
            await self.studio.compile_expected()
            self.tell({"tell": "preparing", "is": False})
        drawn = await self.studio.do(session.drawn, frame, look, self.view, across)
        self.show("drawn", packed_pixels({"kind": "drawn", "frame": frame}, drawn))

    def optimise(self, course: Mapping[str, float], steps: int) -> None:
        """Have the optimiser take steps, each shown; what it was to do before is over.

        Args:
            course: See `Descent.of`.
            steps: How many; 0 to let it rest.
        """
        self._course, self._steps = course, steps
        self.view = LIVE if steps else self.view
        self._running.set()

    async def _live(self) -> None:
        """Take steps while there are any to take."""
        while True:
            await self._running.wait()
            self._running.clear()
            while self._steps > 0:
                self._steps -= 1
                try:
                    self.show("mesh", await self.studio.do(self._step, self.frame, self._course))
                except TrimotionError as error:
                    self._steps = 0
                    self.tell({"tell": "problem", "text": str(error)})
                    break
                if self._steps == 0 or (self._is_drawn and monotonic() >= self._draws_at):
                    self._is_drawn = False
                    self.want_drawn()
                while "mesh" in self._pictures:  # no step is taken before the last one is shown
                    await asyncio.sleep(0.002)

    def _step(self, frame: int, course: Mapping[str, float]) -> bytes:
        return self._packed_live(self.studio.session.optimise(frame, course))

    def _packed_live(self, live: Live) -> bytes:
        frame = live.frame.index
        head = {"frame": frame, "view": LIVE, "steps": live.steps, "rmse": live.rmse}
        return packed_work(head, live.worked, live.energies, live.colors)

    def _mesh(self, frame: int, view: str) -> bytes:
        session = self.studio.session
        if view == LIVE and session.live is not None and session.live.frame.index == frame:
            return self._packed_live(session.live)
        view = EDITED if view == LIVE else view
        head = {"frame": frame, "number": session.number, "view": view}
        return packed_mesh(head, session.shown(frame, view=view))

    async def _draw(self) -> None:
        """Draw whenever that is wanted."""
        while True:
            await self._undrawn.wait()
            self._undrawn.clear()
            try:
                begun = monotonic()
                await self.show_drawn()
                self._draws_at = monotonic() + LULL * (monotonic() - begun)
                self._is_drawn = True
            except TrimotionError as error:
                self.tell({"tell": "problem", "text": str(error)})

    async def _send(self) -> None:
        """Send what there is to tell and to show."""
        with suppress(WebSocketDisconnect, RuntimeError):
            while True:
                await self._news.wait()
                self._news.clear()
                words, self._words = self._words, []
                # who is told that an edit is made has its mesh
                if "mesh" in self._pictures:
                    await self._socket.send_bytes(self._pictures.pop("mesh"))
                for text in words:
                    await self._socket.send_text(text)
                while self._pictures:
                    kind = next(iter(self._pictures))
                    await self._socket.send_bytes(self._pictures.pop(kind))

    async def _listen(self) -> None:
        """Answer message after message."""
        while True:
            text = await self._socket.receive_text()
            if not self._pace.is_kept():
                self.studio.log("refused a window that sent too many messages a second")
                await self._socket.close(POLICY, "too many messages a second")
                return
            try:
                asked = read_asked(text)
            except AskError as error:
                self.studio.log(f"refused {error}")
                self.tell({"re": None, "error": str(error)})
                continue
            await self._answer(asked)

    async def _answer(self, asked: Asked) -> None:
        """Do what is asked for; a failure is one line in the window."""
        answer = ANSWERS.get(asked.what)
        try:
            if answer is None:
                raise AskError(f"nothing is called {shown(asked.what)!r}")
            reply = await answer(self, asked)
            self.tell({"re": asked.number, **reply})
        except TrimotionError as error:
            self.tell({"re": asked.number, "error": str(error)})
        except Exception as error:  # a mistake of this program must not end the work of a person
            self.studio.log(f"{shown(asked.what)}: {type(error).__name__}: {shown(str(error))}")
            self.tell({"re": asked.number, "error": "that failed; nothing has changed"})
