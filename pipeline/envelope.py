"""A frame on its way from the source to the output: one envelope, which gains what stages find.

    InShot      its picture and its shot             with_shots, Attention
    Prepared    ... and where its mesh comes from    with_motion, maps of weights
    Solved      what it became                       solved_frames, TrackWriter, Drawing

A stage that adds nothing but weights or smoothness hands on the same kind. What nobody asks for any
more is let go: pictures and motion, once a frame is solved, would fill memory where many frames
wait for each other to be smoothed.
"""

from dataclasses import dataclass, field
from enum import Enum, auto

import numpy as np

from stages.flows.passage import Passage
from stages.flows.view import View
from stages.frame import Frame
from stages.snapshot import Snapshot


class MeshFrom(Enum):
    """Where the mesh of a frame comes from if no motion carries it there."""

    LAYOUT = auto()
    """A mesh starts anew."""
    SAME_PICTURE = auto()
    """Picture and weights are those of the frame before, and so is its mesh."""
    TRACK = auto()
    """An earlier run ended with the frame: it is only given because the next one builds on it."""


@dataclass(frozen=True, eq=False, slots=True)
class Envelope:
    """What is known of a frame wherever it is."""

    shot: int
    """Number of the frame with which its shot begins."""


@dataclass(frozen=True, eq=False, slots=True)
class InShot(Envelope):
    """A frame of the source and its shot."""

    frame: Frame
    """The frame."""
    view: View | None = field(default=None, kw_only=True)
    """Its picture as motion is looked for in it, if that was made."""

    @property
    def opens_shot(self) -> bool:
        """Whether the shot begins with it."""
        return self.shot == self.frame.index


@dataclass(frozen=True, eq=False, slots=True)
class Prepared(InShot):
    """A frame that can be solved."""

    mesh_from: Passage | MeshFrom
    """The motion that carries the mesh of the frame before here, or what there is instead."""

    def solved(self, snapshot: Snapshot, *, keeps_picture: bool) -> "Solved":
        """The frame as it goes on to the output.

        Args:
            snapshot: What it became.
            keeps_picture: Whether a look shows the source.
        """
        return Solved(self.shot, snapshot, self.frame.pixels if keeps_picture else None)


@dataclass(frozen=True, eq=False, slots=True)
class Solved(Envelope):
    """What a frame became."""

    snapshot: Snapshot
    """Its triangles and colours."""
    source: np.ndarray | None = None
    """Its picture [code values], [H, W, 3] uint8; None unless a look needs it."""
    shares: np.ndarray | None = None
    """Which followed regions its triangles belong to, see `Paint`, [T, R]; None for R = 0."""
    is_stored: bool = False
    """Whether the track holds it already."""
    has_more: bool = False
    """Whether the track shall hold the next frame as well or neither: only together can a run go on
    from them."""
    is_shown: bool = True
    """Whether it is part of the output, or only there for those around it."""
