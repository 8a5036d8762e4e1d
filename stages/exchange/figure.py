"""One frame as formats see it."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from stages.mesh import Mesh
from stages.snapshot import Snapshot
from warp_kernels.drawing.paint import Paint


@dataclass(frozen=True, eq=False)
class Figure:
    """A frame: its triangles, their colours, and when it is shown."""

    snapshot: Snapshot
    """Triangles and colours."""
    shot: int
    """Number of the frame with which its shot begins."""
    time: Fraction
    """When it is shown [s from the first frame of the source]."""
    paint: Paint
    """Shapes and colours as styles see them: toned, with strokes that go on."""

    @property
    def index(self) -> int:
        """Number of the frame in the source."""
        return self.snapshot.frame_index

    @property
    def mesh(self) -> Mesh:
        """The triangles."""
        return self.snapshot.mesh

    @cached_property
    def colors(self) -> np.ndarray:
        """Mean colours, as they are drawn [code values], [T, 3] uint8."""
        return np.rint(self.paint.colors).astype(np.uint8)

    @cached_property
    def mean_color(self) -> np.ndarray:
        """That of the whole picture [code values], [3]."""
        areas = self.mesh.areas[:, None]
        return np.asarray((self.paint.colors * areas).sum(axis=0) / areas.sum())
