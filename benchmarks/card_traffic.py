"""Count what a later frame sends to a card, reads from it, launches there and waits for.

    python -m benchmarks.card_traffic [CLIP] [--triangles 300] [--frames 4] [--device cuda-emulated]

No card is needed: the emulated one counts the same. Beside what is done stands what would be if
every array went alone, as it did before copies were gathered. A round is one call of the
optimiser with what is measured and changed before the next.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from functools import wraps
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from pipeline.loop.animate import animate
from pipeline.progress import Progress
from pipeline.track import TrackReader
from stages.media.frame_range import FrameRange
from stages.render import Renderer
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from tests.jobs import job_of
from warp_kernels.device.device import Device
from warp_kernels.device.staging import LAUNCHES, TO_CARD, TO_HOST, WAITS, Staging
from warp_kernels.energy.workspace import Workspace
from warp_kernels.styles import STYLES

CLIP = Path(__file__).parents[1] / "sample_videos" / "shapes.mp4"
ROUNDS, WRITES, READS = "rounds", "arrays written", "arrays read"
HEADS = (TO_CARD, TO_HOST, LAUNCHES, WAITS, WRITES, READS)


class Watch:
    """Counts of calls, beside those of a device."""

    def __init__(self) -> None:
        self.calls: Counter[str] = Counter()
        self.frames: dict[str, list[Counter[str]]] = {"solved": [], "drawn": []}
        self.rounds: list[Counter[str]] = []
        self._begun: Counter[str] | None = None
        self._begin_rounds()
        self._count(Staging, "write", WRITES, lambda *given, **named: 1)
        self._count(Staging, "read", READS, lambda staging, wanted: len(wanted))
        self._note(Triangulator, "next", "solved", lambda owner: owner._device)
        self._note(Renderer, "render", "drawn", lambda owner: owner._canvas.device)

    def _begin_rounds(self) -> None:
        """Note what happens from one call of the optimiser to the next."""
        inner = Workspace.iterate

        @wraps(inner)
        def counted(workspace: Workspace, *given: Any, **named: Any) -> None:
            now = self.calls + workspace.device.traffic
            if self._begun is not None:
                self.rounds.append(now - self._begun)
            self._begun = now
            self.calls[ROUNDS] += 1
            inner(workspace, *given, **named)

        setattr(Workspace, "iterate", counted)  # noqa: B010

    def _count(self, owner: Any, method: str, name: str, many: Callable[..., int]) -> None:
        """Count calls of a method."""
        inner = getattr(owner, method)

        @wraps(inner)
        def counted(*given: Any, **named: Any) -> Any:
            self.calls[name] += many(*given, **named)
            return inner(*given, **named)

        setattr(owner, method, counted)

    def _note(self, owner: Any, method: str, kind: str, device_of: Callable[[Any], Any]) -> None:
        """Note what each call of a method leads to."""
        inner = getattr(owner, method)

        @wraps(inner)
        def noted(this: Any, *given: Any, **named: Any) -> Any:
            before = self.calls + device_of(this).traffic
            self._begun = None
            result = inner(this, *given, **named)
            self.frames[kind].append(self.calls + device_of(this).traffic - before)
            return result

        setattr(owner, method, noted)


def main(arguments: Sequence[str] | None = None) -> None:
    """Convert a few frames, and print what they took."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("clip", nargs="?", type=Path, default=CLIP)
    parser.add_argument("--triangles", type=int, default=300)
    parser.add_argument("--frames", type=int, default=4)
    parser.add_argument("--device", default="cuda-emulated")
    options = parser.parse_args(arguments)
    watch = Watch()
    with TemporaryDirectory() as folder:
        track = Path(folder) / "film.mtrk"
        job = job_of(
            options.clip,
            track=track,
            triangulate=TriangulateOptions(refine=RefineOptions(triangles=options.triangles)),
            frame_range=FrameRange(0, options.frames - 1),
            device=options.device,
        )
        animate(job, Progress())
        with TrackReader(track) as reader, Device(options.device) as device:
            size = reader.header.info.coded_width, reader.header.info.coded_height
            renderer = Renderer(device, size, size, (STYLES["flat"](),))
            for snapshot in reader.snapshots(reader.rows):
                renderer.render(snapshot)
    print(f"{options.clip.name}, {options.triangles} triangles, {options.device}; medians\n")
    print("| what | " + " | ".join(HEADS) + " |")
    print("|---" + "|--:" * len(HEADS) + "|")
    solved, drawn = watch.frames["solved"], watch.frames["drawn"][1:]
    rounds = median(frame[ROUNDS] for frame in solved)
    _print(f"a later frame solved, {rounds:g} rounds", solved)
    _print("a round, from one call of the optimiser to the next", watch.rounds)
    _print("a frame drawn", drawn)


def _print(what: str, frames: Sequence[Counter[str]]) -> None:
    """A line of medians."""
    cells = [median(frame[head] for frame in frames) for head in HEADS]
    print(f"| {what} | " + " | ".join(f"{cell:g}" for cell in cells) + " |")


if __name__ == "__main__":
    sys.exit(main())
