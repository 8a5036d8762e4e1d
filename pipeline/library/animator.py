"""Frames in as arrays, triangulations out: a clip that nobody has as a file."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from threading import Lock
from typing import Any, Unpack, cast

from pipeline.envelope import Solved
from pipeline.library.arrays import options_of_arrays, solved_arrays, told
from pipeline.library.device import opened_device
from pipeline.library.given import given_values
from pipeline.library.keywords import AnimatorKeywords
from pipeline.library.pixels import frame_of, info_of
from pipeline.library.pushed import Pushed
from pipeline.library.signature import with_keywords
from pipeline.library.triangulation import Triangulation
from pipeline.library.wording import worded
from pipeline.loop.convert import triangulator_of
from stages.frame import Frame
from warp_kernels.errors import OptionError
from warp_kernels.limits import MAX_SIDE


class Animator:
    """Turns frames into triangulations that follow them, as `solve` does with a clip.

    The same frames and options give the same triangles, to the bit. A context manager; frames
    come from one thread at a time.

    With `cuts="auto"` a decision about a cut looks at four later frames, and faces are looked for
    in every fourth frame: `feed` gives a frame back up to eight frames later, and `finish` the last
    ones. With `cuts="none", focus="none"` every frame comes back at once, and `new_shot=True` says
    where a shot begins.
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
            MediaError: If a file that an option names cannot be read.
        """
        self._size = _checked(size)
        self._options, self._run = options_of_arrays("Animator", options)
        self._count = 0
        self._frames: dict[int, Frame] = {}
        self._line: Pushed[Frame, Solved] | None = None
        self._is_closed = False
        self._at_work = Lock()
        self._stack = ExitStack()
        with ExitStack() as failing:
            device = failing.enter_context(opened_device(self._run.device, self._run.threads))
            wanted = self._options
            triangulator = triangulator_of(wanted, self._size, device, wanted.model)
            info = info_of(self._size, "video")
            self._solve = partial(
                solved_arrays, options=wanted, triangulator=triangulator, info=info
            )
            self._solve(iter(()))  # a list of cuts or a map of weights that cannot be read
            self._stack = failing.pop_all()

    @worded()
    def feed(self, pixels: Any, *, new_shot: bool = False) -> list[Triangulation]:
        """Take the next frame.

        Args:
            pixels: Code values, [H, W, 3] uint8 in RGB, or [H, W] uint8 in grey; copied.
            new_shot: Whether a shot begins here for certain: what was held back is given back,
                and what comes is like a new clip.

        Returns:
            The frames that are ready, in order; none while a decision is pending.

        Raises:
            OptionError: If the array has another size or kind, or the animator is closed or at work
                in another thread.
        """
        with self._alone():
            return self._fed(pixels, new_shot=new_shot)

    def _fed(self, pixels: Any, *, new_shot: bool) -> list[Triangulation]:
        self._check_open()
        frame = frame_of(pixels, self._count)
        if (frame.width, frame.height) != self._size:
            raise OptionError(
                f"pixels: a frame of {frame.width}x{frame.height}; this animator takes "
                f"{self._size[0]}x{self._size[1]}, so make another one"
            )
        with self._closed_by_failure():
            ready = self._rest() if new_shot else []
            self._count += 1
            self._frames[frame.index] = frame
            if self._line is None:
                self._line = Pushed(self._solve)
            ready += self._line.push(frame)
        return self._told(ready)

    @worded()
    def finish(self) -> list[Triangulation]:
        """Give the frames back that are still held; what is fed later begins a new shot.

        Raises:
            OptionError: If the animator is closed, or at work in another thread.
        """
        with self._alone():
            self._check_open()
            with self._closed_by_failure():
                ready = self._rest()
            return self._told(ready)

    def close(self) -> None:
        """Release the device; frames that are held back are dropped."""
        self._is_closed = True
        self._frames.clear()
        line, self._line = self._line, None
        if line is not None:
            line.close()
        self._stack.close()

    def __enter__(self) -> "Animator":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _check_open(self) -> None:
        if self._is_closed:
            raise OptionError("the animator is closed; make another one")

    @contextmanager
    def _alone(self) -> Iterator[None]:
        """Frames are one after the other: which came first, two threads could not say."""
        if not self._at_work.acquire(blocking=False):
            raise OptionError(
                "the animator is at work in another thread; feed it from one thread, or make an "
                "animator for each clip"
            )
        try:
            yield
        finally:
            self._at_work.release()

    @contextmanager
    def _closed_by_failure(self) -> Iterator[None]:
        """What ends half-way cannot be gone on with."""
        try:
            yield
        except BaseException:
            self.close()
            raise

    def _rest(self) -> list[Solved]:
        """What is held back; the next frame begins another clip."""
        rest = [] if self._line is None else self._line.finish()
        self._line = None
        return rest

    def _told(self, ready: list[Solved]) -> list[Triangulation]:
        """What the caller sees of frames."""
        return [
            told(
                solved,
                self._frames.pop(solved.snapshot.frame_index),
                self._options,
                self._run,
            )
            for solved in ready
        ]


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
