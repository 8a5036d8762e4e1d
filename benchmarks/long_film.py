"""A very long film: memory stays flat, and its last frames are as quick as its first ones.

Run it in the root of the repository: python benchmarks/long_film.py [--frames 20000] [--every 1000]
"""

import argparse
import os
import tempfile
import time
from fractions import Fraction
from pathlib import Path

import av
import numpy as np

from pipeline.loop.animate import animate
from pipeline.options.build import build_job
from pipeline.progress import Progress

WIDTH, HEIGHT = 160, 120
PAGE = os.sysconf("SC_PAGE_SIZE")


class Meter(Progress):
    """Takes the memory and the time of every so many frames.

    Args:
        every: How many.
    """

    def __init__(self, every: int) -> None:
        super().__init__()
        self._every = every
        self._begun = time.process_time()
        self.rows: list[tuple[int, float, float]] = []
        """Frames so far, memory [MB] and time of the CPU for each of the last ones [ms]."""

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Take them, and print them: it takes long."""
        if done % self._every:
            return
        now = time.process_time()
        used = int(Path("/proc/self/statm").read_text().split()[1]) * PAGE / 2**20
        self.rows.append((done, used, 1000 * (now - self._begun) / self._every))
        self._begun = now
        print("| {} | {:.1f} MB | {:.2f} ms |".format(*self.rows[-1]), flush=True)


def write_film(path: Path, count: int) -> None:
    """Write a film of slow waves with a square that runs through them.

    Args:
        path: Its name.
        count: Its frames.
    """
    y, x = np.mgrid[:HEIGHT, :WIDTH].astype(np.float32)
    with av.open(str(path), "w") as output:
        stream = output.add_stream("libx264", rate=25, options={"preset": "ultrafast", "crf": "20"})
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
        stream.codec_context.time_base = Fraction(1, 25)
        for number in range(count):
            wave = np.sin(x / 19 + number / 37) + np.cos(y / 23 - number / 53)
            pixels = np.stack([128 + 50 * wave, 128 - 40 * wave, x], axis=2).astype(np.uint8)
            left = number * 2 % (WIDTH - 30)
            pixels[40:70, left : left + 30] = (250, 240, 30)
            frame = av.VideoFrame.from_ndarray(pixels, format="rgb24")
            frame.pts = number
            output.mux(stream.encode(frame))
        output.mux(stream.encode(None))


def main() -> None:
    """Convert it, and print what the first and the last frames cost."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=20000)
    parser.add_argument("--every", type=int, default=1000)
    parser.add_argument("--triangles", type=int, default=60)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_film(folder / "in.mp4", given.frames)
        wanted = {
            "source": str(folder / "in.mp4"),
            "output": str(folder / "out.mp4"),
            "track": str(folder / "out.mtrk"),
            "triangles": given.triangles,
            "frame_iterations": 4,
        }
        meter = Meter(given.every)
        animate(build_job(wanted), meter)
    rows = meter.rows[1:]  # what is made at the beginning is made by then
    memory, times = [row[1] for row in rows], [row[2] for row in rows]
    print(f"memory: {memory[0]:.0f} to {memory[-1]:.0f} MB, {memory[-1] / memory[0] - 1:+.1%}")
    print(f"time a frame: {times[0]:.2f} to {times[-1]:.2f} ms, {times[-1] / times[0] - 1:+.1%}")


if __name__ == "__main__":
    main()
