"""The colour that most pixels of a triangle share, where its other pixels are of another one.

A triangle that lies on white and grazes a letter has a mean that neither the letter nor the paper
has.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.device.staging import ArrayRows
from warp_kernels.energy.triangle_walk import columns_of, step_down, walk_triangle
from warp_kernels.energy.workspace import Workspace

wp.set_module_options(EXACT)

REACHES = (64, 24, 12)
"""Pixels this close to a colour, in every channel, say what the next colour is, time after time
[code values]: the first one lies between two, and is led to that of the larger part."""
MANY = 1 << 30
"""More rows than there are: all of them [px]."""
SAMPLED = 8
"""Rows of a triangle, about, that are looked at before all of them are [px]."""
LEAST_PART = 0.5
"""Where a smaller part of the pixels of these rows is close to the last colour the triangle does
not lie on plain ground, and is left alone."""


@wp.struct
class Company:
    """The pixels close to a colour."""

    count: int
    """How many there are."""
    seen: int
    """Pixels that were looked at."""
    sums: wp.vec3l
    """Of each channel [code values]."""
    squares: wp.int64
    """Of all channels together [code value^2]."""


@wp.func
def company_of(
    color: wp.vec3i,
    reach: int,
    sampled: int,
    a: wp.vec2d,
    b: wp.vec2d,
    c: wp.vec2d,
    pixels: wp.array2d(dtype=wp.vec3ub),
) -> Company:
    """Walk over a triangle's pixels, or about so many rows, and take those close to a colour."""
    result = Company()
    walk = walk_triangle(a, b, c, pixels.shape[0])
    stride = wp.max((walk.end - walk.row) / sampled, 1)
    row = walk.row + 1 + stride / 2
    while walk.row + 1 < walk.end:
        walk = step_down(walk, pixels.shape[0])
        if walk.row < row:
            continue
        row += stride
        columns = columns_of(walk, pixels.shape[1])
        result.seen += wp.max(columns[1] - columns[0], 0)
        sums, squares = wp.vec3i(), int(0)  # of a row, which is short enough for that
        for column in range(columns[0], columns[1]):
            pixel = pixels[walk.row, column]
            value = wp.vec3i(int(pixel[0]), int(pixel[1]), int(pixel[2]))
            away = wp.abs(value - color)
            if wp.max(away[0], wp.max(away[1], away[2])) <= reach:
                result.count += 1
                sums += value
                squares += wp.dot(away, away)
        for channel in range(3):
            result.sums[channel] += wp.int64(sums[channel])
        result.squares += wp.int64(squares)
    return result


@wp.func
def middle_of(company: Company) -> wp.vec3i:
    """The mean of some pixels, rounded."""
    count = wp.int64(company.count)
    result = wp.vec3i()
    for channel in range(3):
        result[channel] = int((company.sums[channel] + count / wp.int64(2)) / count)
    return result


@wp.kernel(enable_backward=False)
def find_plain_colors(
    span: wp.array(dtype=wp.vec2i),
    # In:
    vertices: wp.array(dtype=wp.vec2d),
    triangles: wp.array(dtype=wp.vec3i),
    pixels: wp.array2d(dtype=wp.vec3ub),
    colors: wp.array(dtype=wp.vec3i),
    # Out:
    counts_out: wp.array(dtype=int),
    colors_out: wp.array(dtype=wp.vec3d),
    spreads_out: wp.array(dtype=wp.float64),
):
    """Lead the colour of one triangle to that of most of its pixels."""
    triangle = span[0][0] + wp.tid()
    if triangle >= span[0][1]:
        return
    counts_out[triangle] = 0
    colors_out[triangle] = wp.vec3d()
    spreads_out[triangle] = wp.float64(0.0)
    color = colors[triangle]
    if color[0] < 0:
        return
    corners = triangles[triangle]
    a, b, c = vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]
    least = wp.float64(wp.static(LEAST_PART))
    for n in range(wp.static(len(REACHES))):
        reach = wp.static(wp.vec3i(*REACHES))[n]
        some = company_of(color, reach, wp.static(SAMPLED), a, b, c, pixels)
        if some.count == 0 or wp.float64(some.count) < least * wp.float64(some.seen):
            return
        color = middle_of(some)
    reach = wp.static(REACHES[-1])
    found = company_of(color, reach, wp.static(MANY), a, b, c, pixels)
    if found.count == 0:
        return
    count = wp.float64(found.count)
    mean = wp.vec3d()
    squares = wp.float64(found.squares) / count
    for channel in range(3):
        mean[channel] = wp.float64(found.sums[channel]) / count
        away = mean[channel] - wp.float64(color[channel])
        squares -= away * away
    counts_out[triangle] = found.count
    colors_out[triangle] = mean
    spreads_out[triangle] = wp.sqrt(wp.max(squares, wp.float64(0.0)) / wp.float64(3.0))


@dataclass(frozen=True, eq=False)
class Plain:
    """What most pixels of each triangle look like, as far as they look alike."""

    counts: np.ndarray
    """Pixels that are close to one colour, [T] int; where there is none the rest means nothing."""
    colors: np.ndarray
    """Their mean [code values], [T, 3]."""
    spreads: np.ndarray
    """Their standard deviation per channel [code values], [T]."""


class PlainColors:
    """Looks for such pixels, over the picture in a workspace.

    Args:
        workspace: Holds the picture and the mesh.
    """

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._generation = -1
        self._recorded: dict[Any, Phase] = {}

    def measure(self, colors: np.ndarray, asked: np.ndarray) -> Plain:
        """Look at the mesh as it stands.

        Args:
            colors: Means of the triangles [code values], [T, 3].
            asked: Triangles that are to be looked at, [T] bool.
        """
        workspace, device = self._workspace, self._workspace.device
        if self._generation != workspace.generation:
            count, empty = workspace.capacity[1], device.empty
            self._given = empty(count, wp.vec3i)
            self._found = (empty(count, int), empty(count, wp.vec3d), empty(count, wp.float64))
            self._generation = workspace.generation
            self._recorded.clear()
        device.write(self._given, np.where(asked[:, None], np.rint(colors), -1).astype(np.int32))
        place = workspace.standing.ptr
        if place not in self._recorded:
            inputs = [workspace.standing, workspace.triangles, workspace.pixels, self._given]
            self._recorded[place] = device.record(find_plain_colors, inputs, self._found)
        phase = self._recorded[place]
        phase.resize(len(colors))
        device.run([phase])
        return Plain(*device.read_all([ArrayRows(array, len(colors)) for array in self._found]))
