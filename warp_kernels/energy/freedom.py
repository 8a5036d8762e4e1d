"""Which vertices may move and which have moved, in device memory."""

import numpy as np
import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.moments.due import MOVED


class Freedom:
    """Arrays for the vertices of one mesh at a time.

    Args:
        device: Where they lie.
        vertices: How many they have room for.
    """

    def __init__(self, device: Device, vertices: int) -> None:
        self._device = device
        self.axes = device.empty(vertices, wp.vec2d)
        """1 where a coordinate may change, else 0, [V]."""
        self.marks = device.empty(vertices, wp.int32)
        """What has moved since sums were taken, see `due`, [V]."""
        self._own = np.zeros((0, 2))
        self._resting: np.ndarray | None = None

    def load(self, axes: np.ndarray) -> None:
        """Take in a mesh of which nothing is known yet.

        Args:
            axes: 1 where the border lets a coordinate change, else 0, [V, 2].
        """
        self._own, self._resting = axes, None
        self._device.write(self.axes, axes)
        self.know_nothing()

    def rest(self, marks: np.ndarray | None) -> None:
        """Let some vertices rest until told otherwise.

        Args:
            marks: `MOVED` for those that are free, `BESIDE` for their neighbours and 0 for all
                others, [V] int32; None to let none rest.
        """
        if marks is None and self._resting is not None:
            self.load(self._own)
        elif marks is not None:
            self._resting = marks
            self._device.write(self.axes, self._own * (marks == MOVED)[:, None])
            self._device.write(self.marks, marks)

    def know_nothing(self) -> None:
        """All that was summed is void, and needed again as far as anything may move."""
        marks = self._resting
        if marks is None:
            marks = np.full(len(self._own), MOVED, dtype=np.int32)
        self._device.write(self.marks, marks)

    def know_all(self) -> None:
        """Have what was left out around resting vertices summed as well."""
        if self._resting is not None:
            self._device.write(self.marks, np.full(len(self._own), MOVED, dtype=np.int32))
