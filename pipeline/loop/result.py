"""What a run comes to, counted while it goes on."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from time import perf_counter

import numpy as np

from pipeline.envelope import Solved
from pipeline.options.job import Job
from pipeline.progress import Progress
from pipeline.stage_times import StageTimes
from pipeline.track import FrameRow
from stages.mesh import Mesh
from stages.metrics.changed_triangles import changed_triangles
from warp_kernels.device.memory import peak_memory, refuse_without_room


@dataclass(frozen=True, slots=True)
class TalliedFrame:
    """What a report says of a frame."""

    frame: int
    """Its number in the source."""
    shot: int
    """Number of the frame with which its shot begins."""
    triangles: int
    """Triangles."""
    rmse: float
    """Error [code values]."""
    changes: int | None
    """Triangles that were not there in the frame before; None where a shot begins or goes on from
    a frame that is not at hand."""
    seconds: float
    """Time since the frame before was finished in the same process, or since its work began [s]."""


@dataclass(frozen=True)
class Animated:
    """What a finished job came to."""

    frames: int
    """Frames written."""
    seconds: float
    """Wall time, from the first frame's decoding to the finished file [s]."""
    mean_rmse: float
    """Mean over the frames of the root mean square error [code values]."""
    warnings: tuple[str, ...]
    """Damage that was met, one sentence each."""
    notes: tuple[str, ...]
    """Choices that were made, one sentence each."""
    figures: tuple[TalliedFrame, ...] = ()
    """Of every frame, in order, if a report is wanted."""
    stages: tuple[tuple[str, float], ...] = ()
    """Parts of the wall time, by name [s], if a report is wanted."""
    busy: Mapping[str, float] = field(default_factory=dict)
    """How long each stage worked, by name [s]; they run side by side, in every process."""
    memory: int | None = None
    """Most memory that this process had [bytes], if it is known."""
    memory_apart: int | None = None
    """Likewise of the largest process of those that solved ranges beside it."""


class Tally:
    """Counts finished frames and tells of them.

    Args:
        job: Says whether there will be a report.
        progress: Told of every frame.
        total: How many there will be, None if unknown.
    """

    def __init__(self, job: Job, progress: Progress, total: int | None) -> None:
        self._keeps = job.run.report is not None
        self._is_linked = not job.solve.independent
        self._progress = progress
        self._total = total
        self._errors: list[float] = []
        self._figures: list[TalliedFrame] = []
        self._mesh: Mesh | None = None
        self._clock = perf_counter()
        self._told = 0
        self.times = StageTimes()
        """How long each stage works."""

    def solved(self, one: Solved) -> None:
        """Count a frame and tell of it."""
        refuse_without_room()
        snapshot = one.snapshot
        mesh, rmse = snapshot.mesh, snapshot.rmse
        self._add(snapshot.frame_index, one.shot, mesh.triangle_count, rmse, mesh)
        self._told += 1
        self._progress.frame(len(self._errors), self._total, mesh.triangle_count, rmse)

    def recalled(self, row: FrameRow) -> None:
        """Count a frame that an earlier run told of and that is not drawn."""
        self._add(row.frame, row.shot, row.triangle_count, row.rmse, None)

    def _add(self, frame: int, shot: int, triangles: int, rmse: float, mesh: Mesh | None) -> None:
        self._errors.append(rmse)
        if self._keeps:
            now = perf_counter()
            changes, seconds = self._changes(shot, mesh), now - self._clock
            self._figures.append(TalliedFrame(frame, shot, triangles, rmse, changes, seconds))
            self._mesh, self._clock = mesh, now

    def _changes(self, shot: int, mesh: Mesh | None) -> int | None:
        goes_on = bool(self._figures) and self._figures[-1].shot == shot and self._is_linked
        if not goes_on or mesh is None or self._mesh is None:
            return None
        return changed_triangles(self._mesh, mesh)

    def result(self, begun: float, warnings: Iterable[str], notes: Iterable[str]) -> Animated:
        """What the job came to."""
        seconds = perf_counter() - begun
        return Animated(
            frames=self._told,
            seconds=seconds,
            mean_rmse=float(np.mean(self._errors)),
            warnings=tuple(warnings),
            notes=tuple(notes),
            figures=tuple(self._figures),
            stages=self._stages(seconds),
            busy=self.times.seconds,
            memory=peak_memory(),
        )

    def _stages(self, seconds: float) -> tuple[tuple[str, float], ...]:
        """When the frames were finished; the last ones are still drawn and written then."""
        if not self._figures:
            return ()
        later = sum(one.seconds for one in self._figures[1:])
        rest = perf_counter() - self._clock
        return (
            ("before the first frame was solved", seconds - later - rest),
            ("until the last frame was solved", later),
            ("until all was written", rest),
        )
