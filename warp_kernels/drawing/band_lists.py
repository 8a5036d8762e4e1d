"""Which triangles may lie in which band of the output: a band is filled by looking at these alone.

An output of many pixels has hundreds of bands and each triangle lies in a few of them, so that to
look at all of them in each band took longer than to fill it.
"""

import numpy as np
import warp as wp

from warp_kernels.device.device import Device

ROUNDING = 0.01
"""Coverage rounds corners by less than this [px of the output]."""


class BandLists:
    """Lists in device memory, one for each band of the output.

    Args:
        device: Where they lie.
        height: Rows of the output [px].
        band: Rows of a band [px].
    """

    def __init__(self, device: Device, height: int, band: int) -> None:
        self._device, self._height, self._band = device, height, band
        self._count = -(-height // band)
        self.begins = device.empty(self._count + 1, int)
        """Where in `listed` each band's triangles begin, and where the last one's end, [B + 1]."""
        self._allocate(4096)

    def _allocate(self, count: int) -> None:
        self.listed: wp.array = self._device.empty(count, int)
        """Numbers of triangles, ascending in each band."""

    def write(self, vertices: np.ndarray, triangles: np.ndarray, scale: float) -> bool:
        """List the triangles of a mesh.

        Args:
            vertices: Positions [px of the picture], [V, 2].
            triangles: Corners, [T, 3].
            scale: Rows of the output per row of the picture.

        Returns:
            Whether `listed` is another array now.
        """
        listed, begins = self._listed(scale * vertices[:, 1], triangles)
        moved = len(listed) > len(self.listed)
        if moved:
            self._allocate(len(listed) * 3 // 2)
        self._device.write(self.listed, listed)
        self._device.write(self.begins, begins)
        return moved

    def _listed(self, rows: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What is written, of vertices in such rows of the output [px], [V]."""
        if self._count == 1:
            return np.arange(len(triangles)), np.array([0, len(triangles)])
        of_corners = rows.take(triangles)
        low, high = of_corners.min(axis=1) - ROUNDING, of_corners.max(axis=1) + ROUNDING
        seen = np.flatnonzero((high >= 0) & (low <= self._height))
        ends = np.stack([low[seen], high[seen]]) / self._band
        first, last = np.clip(ends, 0, self._count - 1).astype(np.int64)
        spans = last - first + 1
        before = np.cumsum(spans) - spans
        bands = np.arange(spans.sum()) + np.repeat(first - before, spans)
        order = np.argsort(bands.astype(np.uint16), kind="stable")  # short keys are sorted fastest
        begins = np.zeros(self._count + 1, dtype=np.int64)
        np.cumsum(np.bincount(bands, minlength=self._count), out=begins[1:])
        return np.repeat(seen, spans)[order], begins
