"""A Chromium that is driven by as little as possible: what is measured in it is the page's own.

Playwright has every message of a socket told, pictures of three megabytes among them, which takes
longer than drawing them.
"""

import json
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any
from urllib.request import urlopen

from websockets.sync.client import ClientConnection, connect

FLAGS = (
    "--headless=new --no-sandbox --enable-unsafe-swiftshader --remote-debugging-port=0 "
    "--no-first-run --hide-scrollbars --mute-audio"
)
PATIENCE = 120.0
"""How long something may take [s]."""


class NotThereError(RuntimeError):
    """There is no page yet that could answer."""


class Tab:
    """A page that is open.

    Args:
        line: The line to the browser.
    """

    def __init__(self, line: ClientConnection) -> None:
        self._line, self._number = line, 0

    def evaluate(self, expression: str, *arguments: object) -> Any:
        """What a function of JavaScript returns, once its promise is kept.

        Args:
            expression: The function.
            arguments: What it is given.
        """
        given = ", ".join(json.dumps(one) for one in arguments)
        found = self._told(
            "Runtime.evaluate",
            expression=f"({expression})({given})",
            awaitPromise=True,
            returnByValue=True,
        )
        if "exceptionDetails" in found:
            raise RuntimeError(json.dumps(found["exceptionDetails"])[:500])
        return found["result"].get("value")

    def wait(self, expression: str, *arguments: object) -> None:
        """Wait until a function returns something true."""
        ends = time.monotonic() + PATIENCE
        while time.monotonic() < ends:
            with suppress(NotThereError):
                if self.evaluate(f"(...given) => Boolean(({expression})(...given))", *arguments):
                    return
            time.sleep(0.02)
        raise TimeoutError(expression)

    def mouse(self, kind: str, x: float, y: float, button: str = "none") -> None:
        """Move, press or release the mouse.

        Args:
            kind: `Moved`, `Pressed` or `Released`.
            x: Place on the page, to the right [px].
            y: The same, down.
            button: `left`, or `none`.
        """
        clicks = 0 if button == "none" else 1
        told = {"type": f"mouse{kind}", "x": x, "y": y, "button": button, "clickCount": clicks}
        self._told("Input.dispatchMouseEvent", **told)

    def click(self, x: float, y: float) -> None:
        """Click with the left button."""
        self.mouse("Pressed", x, y, "left")
        self.mouse("Released", x, y, "left")

    def _told(self, method: str, **parameters: object) -> Any:
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        self._line.send(json.dumps(message))
        while True:
            found = json.loads(self._line.recv(timeout=PATIENCE))
            if found.get("id") == self._number:
                if "error" in found:
                    raise NotThereError(f"{method}: {found['error']}")
                return found["result"]


@contextmanager
def opened_tab(url: str, size: tuple[int, int]) -> Iterator[Tab]:
    """A page while the block runs.

    Args:
        url: Its address.
        size: Width and height of its window [px].
    """
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        words = [shutil.which("chromium") or "chromium", *FLAGS.split(), url]
        words += [f"--user-data-dir={folder}", f"--window-size={size[0]},{size[1]}"]
        nowhere = subprocess.DEVNULL
        with subprocess.Popen(words, stdout=nowhere, stderr=nowhere) as program:
            try:
                with connect(_address(Path(folder), url), max_size=None) as line:
                    yield Tab(line)
            finally:
                program.terminate()


def _address(folder: Path, url: str) -> str:
    """Where the tab with a page is reached."""
    ends = time.monotonic() + PATIENCE
    while time.monotonic() < ends:
        told = folder / "DevToolsActivePort"
        if told.exists() and (lines := told.read_text().split()):
            with urlopen(f"http://127.0.0.1:{lines[0]}/json") as answer:
                tabs = json.load(answer)
            for tab in tabs:
                if tab["url"] == url:
                    return str(tab["webSocketDebuggerUrl"])
        time.sleep(0.1)
    raise TimeoutError("no Chromium")
