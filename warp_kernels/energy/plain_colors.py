"""The colour that most pixels of a triangle share, where its other pixels are of another one.

A triangle that lies on white and grazes a letter has a mean that neither the letter nor the paper
has. The colour is found by a vote among some pixels: one that most of them have outlives all others
in a single pass, whatever their order. Then only the others are visited: what the rest looks like
follows from them and from the fit.

Source: Boyer & Moore, "MJRTY: a fast majority vote algorithm" (1991).
Deviation: colours close to the candidate vote for it, since pictures have noise.
"""

from dataclasses import dataclass

import numpy as np
import warp as wp

from warp_kernels.color_model import CHANNELS
from warp_kernels.device.exact import EXACT
from warp_kernels.energy.nearby_colors import (
    channel_by_channel,
    first_outside,
    read,
    read_whole,
)
from warp_kernels.energy.triangle_look import Column, TriangleLook
from warp_kernels.energy.triangle_walk import columns_of, step_down, walk_triangle
from warp_kernels.energy.workspace import Workspace

wp.set_module_options(EXACT)

REACH = 12
"""Pixels this close to the colour that was voted for, in every channel, look like it [code
values]."""
MOST_OTHERS = 0.3
"""Share of other pixels beyond which a triangle is not looked at any further."""
CLEAR = 5
"""A colour that seven in ten have leads by two fifths of the votes; by one in so many at least, for
few vote."""
VOTERS = 64.0
"""About so many pixels of a triangle vote."""


@wp.struct
class Vote:
    """What most pixels look like, if there is such a colour."""

    color: wp.vec3i
    """The colour [code values]."""
    is_clear: bool
    """Whether it may be that of `1 - MOST_OTHERS` of all pixels."""


@wp.func
def vote(
    a: wp.vec2d, b: wp.vec2d, c: wp.vec2d, pixels: wp.array2d(dtype=wp.vec3ub), stride: int
) -> Vote:
    """Let one pixel of a triangle in `stride` vote, along rows and from row to row."""
    walk = walk_triangle(a, b, c, pixels.shape[0])
    begin = walk.row + 1
    result = Vote()
    lead = int(0)
    voters = int(0)
    while walk.row + 1 < walk.end:
        walk = step_down(walk, pixels.shape[0])
        if (walk.row - begin) % stride == 0:
            columns = columns_of(walk, pixels.shape[1])
            column = columns[0]
            while column < columns[1]:
                value = read_whole(pixels, walk.row, column)
                if lead == 0:
                    result.color = value
                away = wp.abs(value - result.color)
                farthest = wp.max(away[0], wp.max(away[1], away[2]))
                lead += wp.where(farthest <= wp.static(REACH), 1, -1)
                voters += 1
                column += stride
    result.is_clear = lead * wp.static(CLEAR) >= voters
    return result


@wp.kernel(enable_backward=False)
def find_plain_colors(
    span: wp.array(dtype=wp.vec2i),
    # In:
    vertices: wp.array(dtype=wp.vec2d),
    triangles: wp.array(dtype=wp.vec3i),
    pixels: wp.array2d(dtype=wp.vec3ub),
    counts: wp.array(dtype=int),
    # Out:
    others_out: wp.array(dtype=int),
    sums_out: wp.array(dtype=wp.vec3d),
    squares_out: wp.array(dtype=wp.float64),
):
    """Walk over one triangle's pixels, and sum up those that have another colour than most."""
    triangle = span[0][0] + wp.tid()
    if triangle >= span[0][1]:
        return
    others_out[triangle] = counts[triangle]
    sums_out[triangle] = wp.vec3d()
    squares_out[triangle] = wp.float64(0.0)
    if counts[triangle] == 0:
        return
    corners = triangles[triangle]
    a, b, c = vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]
    stride = int(wp.sqrt(float(counts[triangle]) / wp.static(VOTERS)))
    most = vote(a, b, c, pixels, wp.max(stride, 1))
    if not most.is_clear:
        return
    away = wp.vec3i(wp.static(REACH), wp.static(REACH), wp.static(REACH))
    low = channel_by_channel(wp.vec3d(most.color - away))
    high = channel_by_channel(wp.vec3d(most.color + away))
    bearable = int(float(counts[triangle]) * wp.static(MOST_OTHERS))
    others = int(0)
    sums, squares = wp.vec3d(), wp.float64(0.0)  # whole numbers: exact in any order
    walk = walk_triangle(a, b, c, pixels.shape[0])
    while walk.row + 1 < walk.end:
        walk = step_down(walk, pixels.shape[0])
        columns = columns_of(walk, pixels.shape[1])
        column = first_outside(pixels, walk.row, columns[0], columns[1], low, high)
        while column < columns[1]:
            value = read(pixels, walk.row, column)
            sums += value
            squares += wp.dot(value, value)
            others += 1
            column = first_outside(pixels, walk.row, column + 1, columns[1], low, high)
        if others > bearable:
            return
    others_out[triangle] = others
    sums_out[triangle] = sums
    squares_out[triangle] = squares


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
        self._look = TriangleLook(
            workspace,
            find_plain_colors,
            fixed=[workspace.pixels],
            given=[Column(int)],
            found=[Column(int), Column(wp.vec3d), Column(wp.float64)],
        )

    def measure(self, counts: np.ndarray, means: np.ndarray, energies: np.ndarray) -> Plain:
        """Look at the mesh as it stands.

        Args:
            counts: Pixels of each triangle; 0 for those that shall not be looked at, [T].
            means: Mean colours of all of them [code values], [T, 3].
            energies: What these leave [code value^2 px], [T].
        """
        others, sums, squares = self._look.look(len(counts), [counts])
        alike = counts - others
        count = np.maximum(alike, 1)
        colors = (counts[:, None] * means - sums) / count[:, None]
        all_squares = 2.0 * energies + counts * np.square(means).sum(axis=1)
        variances = (all_squares - squares) / count - np.square(colors).sum(axis=1)
        return Plain(alike, colors, np.sqrt(np.maximum(variances, 0.0) / CHANNELS))
