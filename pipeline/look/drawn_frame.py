"""A frame on its way from the solution to the output."""

from dataclasses import dataclass

import numpy as np

from stages.snapshot import Snapshot


@dataclass(frozen=True, eq=False, slots=True)
class Take:
    """What is drawn."""

    snapshot: Snapshot
    """The frame's triangles and colours."""
    shot: int
    """Number of the frame with which its shot begins."""
    is_shown: bool = True
    """Whether it is part of the output, or only there for those around it."""
    source: np.ndarray | None = None
    """The picture that it was made from [code values], [H, W, 3]; None unless a look needs it."""
    shares: np.ndarray | None = None
    """Which followed regions its triangles belong to, see `Paint`, [T, R]; None for R = 0."""
