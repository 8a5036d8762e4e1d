"""What a decoder hands over beside the pixels of a frame."""

import gc
from typing import Any

from av.dictionary import Dictionary
from av.sidedata.sidedata import Type
from av.video.frame import VideoFrame

from stages.media.reading.kept import keep


def side_data(frame: VideoFrame, name: str) -> bytes | None:
    """One piece of side data.

    PyAV's frame and its side data hold each other afterwards: only the collector frees them.

    Args:
        frame: A decoded frame.
        name: PyAV's name of the kind, such as `DISPLAYMATRIX`.

    Returns:
        Its bytes, or None if the frame has none.
    """
    every: Any = frame.side_data
    pieces = [every[place] for place in range(len(every))]
    for piece in pieces:
        for held in gc.get_referents(piece):
            if isinstance(held, Dictionary):  # a wrapper of what is the frame's
                keep(held)
    return next((bytes(piece) for piece in pieces if piece.type.name == name), None)


def _nameless(cls: Any, value: object) -> Any:
    """A kind that PyAV has no name for: FFmpeg 8 has more than PyAV 18.1, which fails on them."""
    member = object.__new__(cls)
    member._name_, member._value_ = f"KIND_{value}", value
    return member


Type._missing_ = classmethod(_nameless)  # type: ignore[assignment]
