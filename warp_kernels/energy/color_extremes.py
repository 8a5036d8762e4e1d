"""The darkest and the brightest of the pixels below every triangle, channel by channel."""

import numpy as np
import warp as wp

from warp_kernels.color_model import CHANNELS
from warp_kernels.device.exact import EXACT
from warp_kernels.energy.triangle_look import Column, TriangleLook
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
        self._look = TriangleLook(
            workspace,
            find_extremes,
            fixed=[workspace.pixels],
            found=[Column(wp.uint8, (2, CHANNELS))],
        )

    def measure(self, triangle_count: int) -> np.ndarray:
        """Look at the mesh as it stands.

        Args:
            triangle_count: Its number of triangles T.

        Returns:
            `DARKEST` and `BRIGHTEST` of each channel of the workspace's picture [code values],
            [T, 2, 3] uint8.
        """
        (found,) = self._look.look(triangle_count)
        return found
