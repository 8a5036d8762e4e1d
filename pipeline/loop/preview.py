"""A few moments of a job as it will be, and how long the whole would take.

Each moment is followed over some frames, as in the film, in a run of its own: what it shows is a
later frame, and what is measured is how long later frames take, with all that runs beside.
"""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil, floor
from pathlib import Path
from time import perf_counter

import numpy as np

from pipeline.loop.animate import animate
from pipeline.options.job import Job
from pipeline.options.output import Output
from pipeline.progress import Progress
from stages.media import FrameRange, MediaInfo, count_frames, open_decoder, probe
from warp_kernels.errors import OptionError

MOMENTS = 5
"""Moments, evenly spread."""
TIMED, SHORT = 8, 1
"""Frames that come before a moment: of every second one more, by which the time is told."""
RUN_IN = 4
"""Frames prepared ahead while the first one was solved: they come too soon to be measured."""
ENDINGS = {"vp9": ".webm", "prores": ".mov", "ffv1": ".mkv"}
"""Formats for codecs that mp4 does not hold."""
JUMP = 3.0
"""What takes so many times as long as usual is the first frame of another shot."""


@dataclass(frozen=True, eq=False)
class Moment:
    """A frame of the film that will be."""

    frame: int
    """Its number in the source."""
    time: Fraction | None
    """When it is shown [s from the start], None for what carries no times."""
    pixels: np.ndarray
    """Code values, [rows, columns, 3] uint8, with square pixels or nearly so."""


@dataclass(frozen=True, eq=False)
class Preview:
    """What is known of a film before it is made."""

    moments: tuple[Moment, ...]
    """Some of its frames, in order."""
    frames: int
    """How many it will have."""
    first: float
    """How long the first frame of a shot takes [s]."""
    later: float
    """How long every later one takes [s]; 0 if there is none."""
    notes: tuple[str, ...]
    """Choices that were made, one sentence each."""

    @property
    def seconds(self) -> float:
        """How long one shot of all frames would take [s]."""
        return self.first + self.later * (self.frames - 1)


def preview(job: Job, progress: Progress) -> Preview:
    """Make some moments of a job.

    Args:
        job: What is to be done; its output is left alone.
        progress: Told of every moment.

    Raises:
        OptionError: If the job follows regions, or its range holds no frame.
        TrimotionError: As `animate` does.
    """
    if job.look.followed:
        region = job.look.followed[0]
        raise OptionError(
            f"--region {region.mask}@{region.frames[0]}: is followed through the whole film, which "
            "a preview does not solve; leave it out"
        )
    info = probe(job.solve.source, read=job.solve.read)
    frames = _frames_of(job, info)
    places = sorted({(2 * i + 1) * len(frames) // (2 * MOMENTS) for i in range(MOMENTS)})
    timing = _Timing()
    moments: list[Moment] = []
    notes: list[str] = []
    with tempfile.TemporaryDirectory(prefix="trimotion-") as folder:
        for number, place in enumerate(places):
            before = TIMED if number % 2 or len(places) == 1 else SHORT
            part = FrameRange(frames[max(0, place - before)], frames[place], frames.step)
            path = Path(folder) / f"{number}{ENDINGS.get(job.output.encode.codec or '', '.mp4')}"
            alone = replace(job, solve=replace(job.solve, frame_range=part))
            notes.extend(timing.run(alone, path, progress))
            frame = frames[place]
            time = None if info.average_rate is None else frame / info.average_rate
            moments.append(Moment(frame, time, _last_picture(path)))
            progress.moment(number + 1, len(places), frame)
    once = tuple(dict.fromkeys(notes))
    return Preview(tuple(moments), len(frames), timing.first, timing.later, once)


class _Timing:
    """Runs parts of a job and measures what their frames take."""

    def __init__(self) -> None:
        self._runs: list[tuple[np.ndarray, float]] = []

    @property
    def first(self) -> float:
        """How long a first frame takes [s]."""
        return float(np.median([times[1] - times[0] for times, _ in self._runs]))

    @property
    def later(self) -> float:
        """How long every later frame takes [s]; 0 if there is none."""
        return later_seconds(self._runs)

    def run(self, job: Job, path: Path, progress: Progress) -> Sequence[str]:
        """Run a part into a file of its own.

        Args:
            job: The part.
            path: The file.
            progress: Told of kernels that are compiled.

        Returns:
            Choices that were made, one sentence each.
        """
        encode = replace(job.output.encode, audio=False, overwrite=True)
        alone = replace(job, output=Output(path, encode), run=replace(job.run, jobs=1))
        clock = _Clock(progress)
        result = animate(alone, clock)
        self._runs.append((np.array(clock.times), perf_counter()))
        return result.notes


def later_seconds(runs: Sequence[tuple[np.ndarray, float]]) -> float:
    """How long every later frame takes, told by runs over parts of a film [s].

    Args:
        runs: When each run began and when each of its frames was solved [s], and when it was over:
            once all was drawn and written as well [s].

    Returns:
        Seconds; 0 where no run has a later frame.
    """
    steps = np.concatenate([np.diff(times[1 + RUN_IN :]) for times, _ in runs])
    counts = np.array([len(times) - 2 for times, _ in runs])
    rests = np.array([ended - times[1] for times, ended in runs])
    if len(steps):
        steps = steps[steps <= JUMP * np.median(steps)]
    solved = float(steps.mean()) if len(steps) else 0.0
    if len(set(counts.tolist())) > 1:
        # drawing may be slower than solving; what it needs once is the same in every run
        return max(solved, float(np.polyfit(counts, rests, 1)[0]))
    return solved or float((rests / np.maximum(counts, 1)).mean() if counts.any() else 0.0)


class _Clock(Progress):
    """Remembers when frames were finished."""

    def __init__(self, whole: Progress) -> None:
        super().__init__()
        self._whole = whole
        self.times = [perf_counter()]
        """The beginning, then the end of every frame [s]."""

    def kernels(self, done: int, total: int | None) -> None:
        """Tell of kernels as always."""
        self._whole.kernels(done, total)

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Look at the clock."""
        self.times.append(perf_counter())


def _frames_of(job: Job, info: MediaInfo) -> range:
    """Numbers of the frames that the job takes."""
    wanted = job.solve.frame_range
    last = info.last_frame
    if last is None or (wanted.last is None and info.kind == "video"):
        last = count_frames(job.solve.source, job.solve.read) - 1
    last = last if wanted.last is None else min(wanted.last, last)
    rate = info.average_rate or Fraction(25)
    start = max(wanted.first, info.first_frame)
    if wanted.start_time is not None:
        start = max(start, info.first_frame + ceil(wanted.start_time * rate))
    if wanted.end_time is not None:
        last = min(last, info.first_frame + floor(wanted.end_time * rate))
    start += (wanted.first - start) % wanted.step
    if start > last:
        raise OptionError(
            f"frames {wanted} of {job.solve.source}: there are none; the source has frames "
            f"{info.first_frame} to {info.last_frame}"
        )
    return range(start, last + 1, wanted.step)


def _last_picture(path: Path) -> np.ndarray:
    """The last frame of a film, [H, W, 3] uint8."""
    picture = None
    with open_decoder(path) as decoder:
        for frame in decoder:
            picture = frame.pixels
    assert picture is not None
    return picture
