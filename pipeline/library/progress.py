"""How a call tells how far it is: not at all, as the command line does, or to a function."""

import sys
from collections.abc import Callable
from dataclasses import dataclass

from pipeline.library.log import log_frame
from pipeline.progress import Progress, open_progress
from warp_kernels.errors import OptionError


@dataclass(frozen=True)
class FrameDone:
    """What a function that was given as `progress` is told of every frame."""

    done: int
    """Frames finished so far."""
    total: int | None
    """Frames in all, as far as is known; may turn out to be wrong."""
    triangles: int | None
    """Triangles of this frame; None from `measure`."""
    rmse: float
    """Its error [code values]."""


Told = bool | Callable[[FrameDone], object] | None
"""None or False for silence, True for a bar or lines, or a function of a `FrameDone`."""


def progress_for(told: Told) -> Progress:
    """What tells of a run.

    Args:
        told: What the caller wants.

    Raises:
        OptionError: If it is something else.
    """
    if told is None or told is False:
        return _Silent()
    if told is True:
        # a notebook's error stream is no terminal, but shows a bar as well as one
        return open_progress("bar" if "ipykernel" in sys.modules else "auto")
    if not callable(told):
        raise OptionError(f"progress={told!r}: give True, None or a function")
    return _Callback(told)


class _Silent(Progress):
    """Tells nothing: warnings are in the result."""

    def warn(self, text: str) -> None:
        """Keep a warning to the result."""

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Log that a frame is finished."""
        log_frame(done, total, rmse)

    def compared(self, done: int, total: int | None, rmse: float) -> None:
        """Log that a frame is compared."""
        log_frame(done, total, rmse)


class _Callback(_Silent):
    """Tells a function; what that raises ends the run."""

    def __init__(self, told: Callable[[FrameDone], object]) -> None:
        super().__init__()
        self._told = told

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Tell that a frame is finished."""
        super().frame(done, total, triangles, rmse)
        self._told(FrameDone(done, total, triangles, rmse))

    def compared(self, done: int, total: int | None, rmse: float) -> None:
        """Tell that a frame is compared."""
        super().compared(done, total, rmse)
        self._told(FrameDone(done, total, None, rmse))
