"""Who solves ranges: each goes to a track of its own, here, beside each other, or elsewhere."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from pipeline.loop.convert import convert
from pipeline.loop.result import Animated
from pipeline.options.job import Job
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import TrackReader
from stages.media import FrameRange
from warp_kernels.color_model import ColorModel


@dataclass(frozen=True)
class Part:
    """A range and where its track goes."""

    frames: FrameRange
    """The range: whole shots if there are others."""
    output: Output
    """Names the track. What an interrupted run left there is gone on with if it resumes."""


@dataclass(frozen=True)
class Work:
    """How ranges are solved, wherever that is: small, and can be sent there."""

    options: SolveOptions
    """What decides the meshes, but for the range."""
    run: Run
    """What the work may use there."""
    fitted: ColorModel
    """The colour model of the snapshots."""

    def solve(self, part: Part, progress: Progress) -> Animated:
        """Solve a range.

        Args:
            part: The range and its track.
            progress: Told of every finished frame; what it raises ends the work.

        Raises:
            TrimotionError: As `pipeline.loop.animate.solve` does.
        """
        options = replace(self.options, frame_range=part.frames)
        job = Job(options, output=replace(part.output, path=None), run=self.run)
        return convert(job, self.fitted, progress)


class RangeRunner(Protocol):
    """Solves ranges by `Work.solve`, in any order and in any place.

    Tracks are equal to the bit whoever makes them. A range that failed may be tried again: it goes
    on with what its track holds.
    """

    @property
    def places(self) -> int:
        """How many ranges it solves at once; more than one is worth looking for shots."""
        ...

    def run(self, work: Work, parts: Sequence[Part], progress: Progress) -> Sequence[Animated]:
        """Solve ranges, each to its track.

        Args:
            work: How.
            parts: The ranges and their tracks.
            progress: Told of every frame of any range; what it raises ends the run.

        Returns:
            What each range came to, in the order of the parts.

        Raises:
            TrimotionError: As `Work.solve` does. However it ends, nothing of it goes on.
        """
        ...


class InThisProcess:
    """Solves one range after the other."""

    places = 1

    def run(self, work: Work, parts: Sequence[Part], progress: Progress) -> Sequence[Animated]:
        """Solve ranges here.

        Args:
            work: How.
            parts: The ranges and their tracks.
            progress: Told of every finished frame.
        """
        told = progress if len(parts) == 1 else Together(progress, parts)
        return [work.solve(part, told) for part in parts]


class Together(Progress):
    """One progress of several ranges, whose frames come in any order.

    Args:
        whole: Told of their sum; begins with what an interrupted run left in their tracks.
        parts: The ranges, each with its last frame, and their tracks.
    """

    def __init__(self, whole: Progress, parts: Sequence[Part]) -> None:
        super().__init__()
        self._whole = whole
        ranges = [part.frames for part in parts]
        self._total = sum((r.last or 0) - r.first + r.step for r in ranges) // ranges[0].step
        self._done = sum(map(_held, parts))

    def kernels(self, done: int, total: int | None) -> None:
        """Tell how far compiling is."""
        self._whole.kernels(done, total)

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Tell of one more frame, whichever it is of its range."""
        self._done += 1
        self._whole.frame(self._done, self._total, triangles, rmse)


def _held(part: Part) -> int:
    """Frames that an interrupted run left in the track of a range."""
    path = part.output.track
    if path is None or not path.exists():
        return 0
    with TrackReader(path) as reader:
        return len(reader.rows)
