"""Measure a whole conversion: frames per second, where the time goes, peak memory.

    python benchmarks/animate.py [CLIP] [--triangles 1500] [--frames A-B]

The first run converts a few frames and is not counted, so kernels are compiled. Stages overlap
in threads, so their seconds (wall time inside each stage) add up to more than the whole.
"""

import argparse
import resource
import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from types import ModuleType
from typing import Any

from timing import machine, program, table

import pipeline.loop.animate
import pipeline.loop.convert
from pipeline.options.job import Job
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from stages.flows.dis import Dis
from stages.media import EncodeOptions, FrameRange
from stages.media.reading.decode import Decoder
from stages.media.writing.encode import Encoder
from stages.render import Renderer
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions

DEFAULT_CLIP = Path(__file__).parents[1] / "sample_videos" / "bigbuckbunny.mp4"
WATCHED: tuple[tuple[str, type | ModuleType, str], ...] = (
    ("decode", Decoder, "__next__"),
    ("flow", Dis, "estimate"),
    ("advect", pipeline.loop.convert, "advect"),
    ("triangulate, first", Triangulator, "first"),
    ("triangulate, next", Triangulator, "next"),
    ("render", Renderer, "render"),
    ("encode", Encoder, "write"),
    ("finish the file", Encoder, "close"),
)
"""Name of a stage and the function that is it."""


@dataclass
class Stage:
    """Time spent in one function."""

    seconds: float = 0.0
    """Wall time inside it [s]."""
    calls: int = 0
    """How often it was entered."""

    def around(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Give the function with a clock around it."""

        def timed(*values: Any, **named: Any) -> Any:
            begun = perf_counter()
            try:
                return function(*values, **named)
            finally:
                self.seconds += perf_counter() - begun
                self.calls += 1

        return timed


@dataclass
class Watch:
    """Clocks around all stages; a context manager."""

    stages: dict[str, Stage] = field(default_factory=dict)
    """By name."""

    def __enter__(self) -> "Watch":
        self._originals = [getattr(owner, name) for _, owner, name in WATCHED]
        for (title, owner, name), original in zip(WATCHED, self._originals, strict=True):
            self.stages[title] = Stage()
            setattr(owner, name, self.stages[title].around(original))
        return self

    def __exit__(self, *_: object) -> None:
        for (_, owner, name), original in zip(WATCHED, self._originals, strict=True):
            setattr(owner, name, original)


def parse() -> argparse.Namespace:
    """Read the command line."""
    parser = program(__doc__)
    parser.add_argument("clip", type=Path, nargs="?", default=DEFAULT_CLIP)
    parser.add_argument("--triangles", type=int, default=1500)
    parser.add_argument("--color", default="constant")
    parser.add_argument("--frames", type=FrameRange.parse, default=FrameRange(), metavar="A-B")
    parser.add_argument("--device", default="cpu", metavar="auto|cpu|cuda:N")
    parser.add_argument("--threads", type=int, default=0, help="0 for one per core")
    return parser.parse_args()


def peak_memory() -> float:
    """Largest resident size of this process so far [MB]."""
    size = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return size / (1e6 if sys.platform == "darwin" else 1e6 / 1024)


def main() -> None:
    """Print the tables."""
    options = parse()
    wanted = TriangulateOptions(
        color=options.color, refine=RefineOptions(triangles=options.triangles)
    )
    with TemporaryDirectory() as folder:
        job = Job(
            SolveOptions(options.clip, frame_range=FrameRange(last=2), triangulate=wanted),
            output=Output(Path(folder) / "out.mp4", EncodeOptions(overwrite=True)),
            run=Run(options.device, options.threads),
        )
        pipeline.loop.animate.animate(job, Progress())
        start_memory = peak_memory()
        job = replace(job, solve=replace(job.solve, frame_range=options.frames))
        with Watch() as watch:
            done = pipeline.loop.animate.animate(job, Progress())
    print(f"{machine()}; {options.clip.name}, {options.triangles} triangles, {options.color}\n")
    print(f"{done.frames} frames in {done.seconds:.2f} s: {done.frames / done.seconds:.2f} fps")
    print(f"mean rmse {done.mean_rmse:.2f}")
    print(f"peak memory {peak_memory():.0f} MB, {start_memory:.0f} MB after three frames\n")
    rows = [
        (
            title,
            stage.calls,
            f"{stage.seconds:.2f}",
            f"{1e3 * stage.seconds / max(1, stage.calls):.1f}",
            f"{100 * stage.seconds / done.seconds:.0f} %",
        )
        for title, stage in watch.stages.items()
    ]
    print(table(("stage", "calls", "seconds", "ms a call", "of the whole"), rows))


if __name__ == "__main__":
    main()
