"""A small job for tests of the editor: a still that is solved, served in this process."""

import os
import shutil
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from pipeline.editor.bench.session import Session
from pipeline.editor.serving.address import Address, listening
from pipeline.editor.serving.server import serve
from pipeline.editor.serving.studio import Studio
from pipeline.track import TrackReader
from tests import media_samples as samples
from tests.tracks import solve_to, write_clip
from warp_kernels.device.device import Device

WAIT = 60.0
"""How long a server may take to start [s]."""


def write_job(folder: Path) -> Path:
    """A track of a still of 96 x 64 in a folder."""
    still = samples.write_still(folder / "still.png", samples.picture(96, 64, 5))
    solve_to(folder / "job.mtrk", still)
    return folder / "job.mtrk"


def write_clip_job(folder: Path) -> Path:
    """A track of a clip of two shots in a folder."""
    clip = write_clip(folder / "clip.mp4")
    solve_to(folder / "clip.mtrk", clip)
    return folder / "clip.mtrk"


def opened(track: Path) -> Session:
    """A session on a track."""
    with TrackReader(track) as reader:
        options = reader.header.whole_solve
    return Session(track, options, Device("cpu"))


@dataclass
class Served:
    """A server that runs."""

    address: Address
    studio: Studio
    lines: list[str] = field(default_factory=list)
    """What it said."""

    @property
    def host(self) -> str:
        """What a request must name."""
        return f"{self.address.host}:{self.address.port}"

    @property
    def socket_url(self) -> str:
        """Where windows connect."""
        return self.address.url.replace("http", "ws", 1) + "socket"


@contextmanager
def served(track: Path) -> Iterator[Served]:
    """Serve a track while the block runs."""
    listener = listening("127.0.0.1", 0)
    lines: list[str] = []
    studio = Studio(opened(track), lines.append)
    address = Address("127.0.0.1", listener.getsockname()[1])
    ready, over = threading.Event(), threading.Event()

    def run() -> None:
        serve(studio, address, listener, opens=False, ready=ready.set, is_over=over.is_set)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    assert ready.wait(WAIT)
    try:
        yield Served(address, studio, lines)
    finally:
        over.set()
        thread.join(WAIT)
        listener.close()


def raw_answer(served: Served, request: bytes) -> bytes:
    """What the server answers to bytes, its first line and headers."""
    with socket.create_connection((served.address.host, served.address.port), timeout=10) as line:
        line.sendall(request)
        found = b""
        while b"\r\n\r\n" not in found and (more := line.recv(65536)):
            found += more
        return found


def browser_path() -> str | None:
    """A Chromium of this machine, or None."""
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
    return os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, names)), None)
