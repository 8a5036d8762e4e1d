"""What is refused before anything looks at it: the wrong word, host, origin or kind of request."""

from collections.abc import Callable
from urllib.parse import quote

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from pipeline.editor.serving.address import Address

HEADERS = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' blob: data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "cache-control": "no-store",
}
"""What every answer says: nothing from elsewhere is loaded, nobody frames it, nothing is kept."""
MOST_SHOWN = 80
"""Letters of a stranger's text that a line of the log shows."""

Log = Callable[[str], None]
"""Takes one line."""


class Guard:
    """Lets those in who know the word, and hands requests on without it.

    Args:
        app: Answers what is let in.
        address: Where the page is found.
        log: Told of what is refused.
    """

    def __init__(self, app: ASGIApp, address: Address, log: Log) -> None:
        self._app, self._address, self._log = app, address, log

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        reason = self._refused(scope)
        if reason is not None:
            self._log(f"refused {self._request(scope)}: {reason}")
            await _refuse(scope, receive, send, reason)
            return
        inside = scope["path"][1 + len(self._address.token) :] or "/"
        own = {**scope, "path": inside, "raw_path": quote(inside).encode()}
        try:
            await self._app(own, receive, _with_headers(send))
        except Exception as error:  # whatever a request does, the program lives and says one line
            self._log(f"{self._request(scope)}: {type(error).__name__}: {shown(str(error))}")

    def _refused(self, scope: Scope) -> str | None:
        """Why a request is refused, or None."""
        headers = [(name.lower(), value.decode("latin-1")) for name, value in scope["headers"]]
        hosts = [value for name, value in headers if name == b"host"]
        origins = [value for name, value in headers if name == b"origin"]
        if len(hosts) != 1 or not self._address.knows_host(hosts[0]):
            return "it is meant for another host"
        if not all(self._address.knows_origin(origin, hosts[0]) for origin in origins):
            return "it comes from another page"
        if not self._address.knows_token(scope["path"]):
            return "it lacks this session's word; open the address that the program printed"
        if scope["type"] == "http" and scope["method"] not in ("GET", "HEAD"):
            return f"{scope['method']} is no way to ask"
        return None

    def _request(self, scope: Scope) -> str:
        """What was asked for, without the word: a log may be passed on."""
        word, _, rest = scope["path"].removeprefix("/").partition("/")
        asked = f"/{'*' * min(len(word), 3)}/{rest}".replace(self._address.token, "***")
        return shown(f"{scope.get('method', 'socket')} {asked}")


def shown(text: str) -> str:
    """A stranger's text as a line of the log can show it.

    Args:
        text: What it said.
    """
    plain = "".join(letter if letter.isprintable() else "?" for letter in text[: MOST_SHOWN + 1])
    return plain if len(plain) <= MOST_SHOWN else f"{plain[:MOST_SHOWN]}..."


async def _refuse(scope: Scope, receive: Receive, send: Send, reason: str) -> None:
    """Say no."""
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": reason})
        return
    body = f"trimotion: {reason}\n".encode()
    headers = [(name.encode(), value.encode()) for name, value in HEADERS.items()]
    headers += [(b"content-type", b"text/plain; charset=utf-8")]
    headers += [(b"content-length", str(len(body)).encode()), (b"connection", b"close")]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def _with_headers(send: Send) -> Send:
    async def answer(message: Message) -> None:
        """Send a part of the answer."""
        if message["type"] == "http.response.start":
            extra = [(name.encode(), value.encode()) for name, value in HEADERS.items()]
            message = {**message, "headers": [*message.get("headers", ()), *extra]}
        await send(message)

    return answer
