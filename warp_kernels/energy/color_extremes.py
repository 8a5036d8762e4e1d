"""The darkest and the brightest of the pixels below every triangle, channel by channel."""

from typing import Any

import numpy as np
import warp as wp

from warp_kernels.color_model import CHANNELS
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.energy.triangle_walk import columns_of, step_down, walk_triangle
from warp_kernels.energy.workspace import Workspace

wp.set_module_options(EXACT)

DARKEST, BRIGHTEST = 0, 1
"""Places in what is measured; without a pixel the darkest is 255 and the brightest 0."""


@wp.kernel(enable_backward=False)
def find_extremes(
    span: wp.array(dtype=wp.vec2i),
    # In:
    vertices: wp.array(dtype=wp.vec2d),
    triangles: wp.array(dtype=wp.vec3i),
    pixels: wp.array2d(dtype=wp.vec3ub),
    # Out:
    extremes_out: wp.array3d(dtype=wp.uint8),
):
    """Walk over one triangle's pixels."""
    triangle = span[0][0] + wp.tid()
    if triangle >= span[0][1]:
        return
    width = pixels.shape[1]
    height = pixels.shape[0]
    corners = triangles[triangle]
    walk = walk_triangle(vertices[corners[0]], vertices[corners[1]], vertices[corners[2]], height)
    low = wp.vec3i(255, 255, 255)
    high = wp.vec3i(0, 0, 0)
    while walk.row + 1 < walk.end:
        walk = step_down(walk, height)
        columns = columns_of(walk, width)
        for column in range(columns[0], columns[1]):
            pixel = pixels[walk.row, column]
            value = wp.vec3i(int(pixel[0]), int(pixel[1]), int(pixel[2]))
            low = wp.min(low, value)
            high = wp.max(high, value)
    for channel in range(3):
        extremes_out[triangle, wp.static(DARKEST), channel] = wp.uint8(low[channel])
        extremes_out[triangle, wp.static(BRIGHTEST), channel] = wp.uint8(high[channel])


class Extremes:
    """Measures the range of the pixels below the triangles in a workspace.

    Args:
        workspace: Holds the picture and the mesh.
    """

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._recorded: tuple[Any, Phase, wp.array] | None = None

    def measure(self, triangle_count: int) -> np.ndarray:
        """Look at the mesh as it stands.

        Args:
            triangle_count: Its number of triangles T.

        Returns:
            `DARKEST` and `BRIGHTEST` of each channel of the workspace's picture [code values],
            [T, 2, 3] uint8.
        """
        workspace = self._workspace
        place = (workspace.generation, workspace.standing.ptr)
        if self._recorded is None or self._recorded[0] != place:
            found = workspace.device.empty((workspace.capacity[1], 2, CHANNELS), wp.uint8)
            inputs = [workspace.standing, workspace.triangles, workspace.pixels]
            phase = workspace.device.record(find_extremes, inputs, [found])
            self._recorded = (place, phase, found)
        _, phase, found = self._recorded
        phase.resize(triangle_count)
        workspace.device.run([phase])
        return workspace.device.read(found, triangle_count)
