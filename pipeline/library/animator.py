"""Frames in as arrays, triangulations out: a clip that nobody has as a file."""

from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from dataclasses import replace
from typing import Any, Unpack, cast

from pipeline.animate import Solved, solved_frames, triangulator_of, weighed
from pipeline.build_job import build_job
from pipeline.job import Job
from pipeline.library.device import opened_device
from pipeline.library.given import given_values
from pipeline.library.keywords import AnimatorKeywords, PictureKeywords
from pipeline.library.pixels import frame_of, weights_of
from pipeline.library.signature import with_keywords
from pipeline.library.triangulation import Origin, Triangulation
from pipeline.library.wording import worded
from pipeline.shots import AHEAD, ShotFrame, with_shots
from pipeline.steps import Step
from stages.flows.passage import Passage
from stages.flows.view import View
from stages.frame import Frame
from stages.weights import open_weights
from warp_kernels.errors import OptionError
from warp_kernels.raster import MAX_SIDE

GIVEN = "(an array)"
"""Stands for the name of a map of weights that has none."""


class Animator:
    """Turns frames into triangulations that follow them, as `solve` does with a clip.

    The same frames and options give the same triangles, to the bit. A context manager; frames
    come from one thread at a time.

    With `cuts="auto"` a decision about a cut looks at four later frames: `feed` gives a frame
    back four frames later, and `finish` the last ones. With `cuts="none"` every frame comes back
    at once, and `new_shot=True` says where a shot begins.
    """

    @with_keywords("Animator")
    @worded()
    def __init__(self, size: tuple[int, int] | str, **options: Unpack[AnimatorKeywords]) -> None:
        """Prepare for frames.

        Args:
            size: Width and height of the frames [px].
            options: See below.

        Raises:
            OptionError: If an option has an impossible value.
        """
        self._size = _checked(size)
        self._job = _job_of("Animator", options)
        self._count = 0
        self._frames: dict[int, Frame] = {}
        self._opened: set[int] = set()
        self._inbox: deque[Frame] = deque()
        self._stack = ExitStack()
        device = opened_device(self._job.device, self._job.threads)
        opened = self._stack.enter_context(device)
        try:
            self._triangulator = triangulator_of(self._job, self._size, opened)
            self._weights = open_weights(self._job.weights, self._size, self._job.frame_range)
            self._begin()
        except BaseException:
            self.close()
            raise

    @property
    def delay(self) -> int:
        """How many frames later `feed` gives a frame back."""
        return AHEAD if self._job.cuts == "auto" else 0

    @worded()
    def feed(self, pixels: Any, *, new_shot: bool = False) -> list[Triangulation]:
        """Take the next frame.

        Args:
            pixels: Code values, [H, W, 3] uint8 in RGB, or [H, W] uint8 in grey; copied.
            new_shot: Whether a shot begins here for certain. With `cuts="auto"` what was held
                back is given back at once, and what comes begins like a new clip.

        Returns:
            The frames that are ready, in order; none while a decision about a cut is pending.

        Raises:
            OptionError: If the array has another size or kind, or the animator is closed.
        """
        self._check_open()
        frame = frame_of(pixels, self._count)
        if (frame.width, frame.height) != self._size:
            raise OptionError(
                f"pixels: a frame of {frame.width}x{frame.height}; this animator takes "
                f"{self._size[0]}x{self._size[1]}, so make another one"
            )
        ready = self._flush() if new_shot and self.delay else []
        if new_shot:
            self._opened.add(frame.index)
        self._count += 1
        self._frames[frame.index] = frame
        self._inbox.append(frame)
        self._waiting += 1
        if self._waiting > self.delay:
            ready.append(self._advance())
        return ready

    @worded()
    def finish(self) -> list[Triangulation]:
        """Give the frames back that are still held; what is fed later begins a new shot.

        Raises:
            OptionError: If the animator is closed.
        """
        self._check_open()
        return self._flush()

    def close(self) -> None:
        """Release the device; frames that are held back are dropped."""
        self._is_closed = True
        self._frames.clear()
        self._stack.close()

    def __enter__(self) -> "Animator":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _check_open(self) -> None:
        if self._is_closed:
            raise OptionError("the animator is closed; make another one")

    def _begin(self) -> None:
        """Begin a clip."""
        self._is_closed = self._is_ended = False
        self._waiting = 0
        shots = self._marked(with_shots(self._taken(), self._job.cuts))
        steps = weighed(_steps(shots, self._job), self._weights)
        self._solved = solved_frames(steps, self._triangulator, self._job, None)

    def _taken(self) -> Iterator[Frame]:
        """Frames as they come; asked for no sooner than there is one, or the end."""
        while self._inbox or not self._is_ended:
            yield self._inbox.popleft()

    def _marked(self, shot_frames: Iterable[ShotFrame]) -> Iterator[ShotFrame]:
        """Shots also begin where the caller says so."""
        for shot_frame in shot_frames:
            is_told = shot_frame.frame.index in self._opened
            self._opened.discard(shot_frame.frame.index)
            yield replace(shot_frame, opens_shot=True) if is_told else shot_frame

    def _flush(self) -> list[Triangulation]:
        """What is held back; then a new clip begins."""
        self._is_ended = True
        ready = [self._advance() for _ in range(self._waiting)]
        self._begin()
        return ready

    def _advance(self) -> Triangulation:
        """Solve the next frame; what is interrupted half-way cannot be gone on with."""
        try:
            solved = next(self._solved)
        except BaseException:
            self.close()
            raise
        self._waiting -= 1
        return _told(solved, self._frames.pop(solved.snapshot.frame_index), self._job)


@with_keywords("triangulate")
@worded()
def triangulate(pixels: Any, **options: Unpack[PictureKeywords]) -> Triangulation:
    """Triangulate one picture.

    Args:
        pixels: Code values, [H, W, 3] uint8 in RGB, or [H, W] uint8 in grey, or anything that
            NumPy makes such an array of.
        options: See below; `weights` may be an array, too, [H, W] uint8.

    Raises:
        OptionError: If the array is of another kind, or an option has an impossible value.
    """
    frame = frame_of(pixels, 0)
    size = (frame.width, frame.height)
    named: Any = dict(options)
    given = named.get("weights")
    if hasattr(given, "__array__"):
        frame = frame_of(frame.pixels, 0, weights_of(given, size))
        named["weights"] = GIVEN
    job = _job_of("triangulate", named)
    with opened_device(job.device, job.threads) as device:
        triangulator = triangulator_of(job, size, device)
        steps: Iterable[Step] = [Step(frame, None, 0)]
        if job.weights not in (None, GIVEN):
            steps = weighed(steps, open_weights(job.weights, size, job.frame_range))
        (solved,) = solved_frames(steps, triangulator, job, None)
        return _told(solved, frame, job)


def _steps(shot_frames: Iterable[ShotFrame], job: Job) -> Iterator[Step]:
    """Estimate the motion between the frames of a shot, as `pipeline.steps` does for a clip."""
    earlier: View | None = None
    shot = 0
    for shot_frame in shot_frames:
        frame = shot_frame.frame
        later = View(frame.pixels)
        passage: Passage | None = None
        if earlier is None or shot_frame.opens_shot:
            shot = frame.index
        elif not job.independent:
            passage = Passage.between(job.flow, earlier, later)
        yield Step(frame, passage, shot)
        earlier = later


def _told(solved: Solved, frame: Frame, job: Job) -> Triangulation:
    """What the caller sees of a frame."""
    origin = Origin(
        color=job.triangulate.color,
        shot=solved.shot,
        frame=frame,
        device=job.device,
        threads=job.threads,
    )
    return Triangulation(solved.snapshot, origin)


def _job_of(function: str, options: Any) -> Job:
    """A job without files."""
    return build_job({"source": "", "output": "", **given_values(function, options)})


def _checked(size: Any) -> tuple[int, int]:
    """Width and height [px].

    Raises:
        OptionError: If they are none, or impossible.
    """
    if size is None:
        raise OptionError("size: give the width and height of the frames, such as (640, 360)")
    read = cast(tuple[int, int], given_values("draw", {"size": size})["output_size"])
    width, height = read
    if not 1 <= min(width, height) <= max(width, height) <= MAX_SIDE:
        raise OptionError(f"size={width}x{height}: sides must lie between 1 and {MAX_SIDE} pixels")
    return width, height
