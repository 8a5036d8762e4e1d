"""The server: answers on one socket until it is told to stop."""

import asyncio
import socket
import webbrowser
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress

import uvicorn
from starlette.applications import Starlette
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from pipeline.editor.serving.address import Address
from pipeline.editor.serving.guard import Guard
from pipeline.editor.serving.page_files import PageFiles
from pipeline.editor.serving.studio import Studio
from pipeline.editor.serving.window import Window
from pipeline.editor.wire.asked import MOST_BYTES

UNUSED = 900.0
"""Without a window for so long the server ends [s]."""
LOOKS = 0.25
"""How often it is looked whether a window is open [s]."""


def app_of(studio: Studio, address: Address) -> ASGIApp:
    """All that is served, behind its guard.

    Args:
        studio: What is worked on.
        address: Where the page is found.
    """

    async def window(socket: WebSocket) -> None:
        """Serve a window."""
        await Window(socket, studio).run()

    @asynccontextmanager
    async def watched(app: Starlette) -> AsyncIterator[None]:
        """Look beside it what other programs do."""
        task = asyncio.create_task(studio.watch())
        yield
        task.cancel()

    files = Route("/{path:path}", PageFiles().answer, methods=["GET"])
    routes = [WebSocketRoute("/socket", window), files]
    return Guard(Starlette(routes=routes, lifespan=watched), address, studio.log)


class _Server(uvicorn.Server):
    """Ends by a signal as one that has done its work: all is on the disk at any time."""

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave signals captured once."""
        with suppress(KeyboardInterrupt), super().capture_signals():
            yield
            self._captured_signals.clear()


def serve(
    studio: Studio,
    address: Address,
    listener: socket.socket,
    *,
    opens: bool,
    ready: Callable[[], None],
    is_over: Callable[[], bool] = lambda: False,
) -> None:
    """Serve until a signal comes, or nobody has looked for `UNUSED` seconds.

    Args:
        studio: What is worked on.
        address: Where the page is found.
        listener: Listens there.
        opens: Whether a browser is opened.
        ready: Called once requests are answered.
        is_over: Asked again and again whether to end.
    """
    config = uvicorn.Config(
        app_of(studio, address),
        log_config=None,
        access_log=False,
        ws="websockets-sansio",
        ws_max_size=MOST_BYTES,
        ws_per_message_deflate=False,
        timeout_graceful_shutdown=1,
        server_header=False,
        proxy_headers=False,
        lifespan="on",
    )
    server = _Server(config)

    async def run() -> None:
        """Serve, and look whether anybody does."""
        serving = asyncio.create_task(server.serve([listener]))
        while not server.started and not serving.done():
            await asyncio.sleep(0.01)
        ready()
        if opens:
            await asyncio.to_thread(webbrowser.open, address.url)
        unused = 0.0
        while not serving.done() and not server.should_exit:
            await asyncio.wait([serving], timeout=LOOKS)
            unused = 0.0 if studio.is_used else unused + LOOKS
            server.should_exit |= unused >= UNUSED or is_over()
        await serving

    try:
        asyncio.run(run())
    finally:
        studio.close()
