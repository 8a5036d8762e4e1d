"""Where triangles show colours that are darker than all pixels around, or brighter than them all.

Most such pixels lie deep on one side of a strong border that their triangle runs over.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.color_model import CHANNELS, ColorModel
from warp_kernels.device.exact import EXACT
from warp_kernels.energy.triangle_look import Column, TriangleLook
from warp_kernels.energy.triangle_walk import columns_of, step_down, walk_triangle
from warp_kernels.energy.workspace import Workspace

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

NEAR = 4
"""Pixels around one count so far away, along rows and along columns [px]."""
LEEWAY = 39.0
"""Most that a colour may leave the range of the pixels around one [code values]."""
BLOCK = 16
"""Pixels whose channels fill whole registers, and are compared at once."""

Bytes = wp.types.vector(length=CHANNELS * BLOCK, dtype=wp.uint8)
"""The channels of a block of pixels, as they lie in memory."""


@wp.struct
class Range:
    """The least and the greatest value of every channel [code values]."""

    low: wp.vec3d
    high: wp.vec3d


@wp.func
def read_whole(pixels: wp.array2d(dtype=wp.vec3ub), row: int, column: int) -> wp.vec3i:
    """A pixel's code values as integers, which compare faster."""
    pixel = pixels[row, column]
    return wp.vec3i(int(pixel[0]), int(pixel[1]), int(pixel[2]))


@wp.func
def read(pixels: wp.array2d(dtype=wp.vec3ub), row: int, column: int) -> wp.vec3d:
    """A pixel's code values."""
    pixel = pixels[row, column]
    return wp.vec3d(wp.float64(pixel[0]), wp.float64(pixel[1]), wp.float64(pixel[2]))


@wp.func
def read_limit(limits: wp.array3d(dtype=wp.uint8), triangle: int, side: int) -> wp.vec3d:
    """The lowest or the highest colour that a triangle shows."""
    return wp.vec3d(
        wp.float64(limits[triangle, side, 0]),
        wp.float64(limits[triangle, side, 1]),
        wp.float64(limits[triangle, side, 2]),
    )


@wp.func
def shown_color(color: wp.vec3d, limits: wp.array3d(dtype=wp.uint8), triangle: int) -> wp.vec3d:
    """A colour within the limits of its triangle."""
    low = read_limit(limits, triangle, 0)
    high = read_limit(limits, triangle, 1)
    return wp.min(wp.max(color, low), high)


@wp.func
def farthest(a: wp.vec3d, b: wp.vec3d) -> wp.float64:
    """How far the most different channels lie apart."""
    away = wp.abs(a - b)
    return wp.max(away[0], wp.max(away[1], away[2]))


@wp.func
def range_around(
    pixels: wp.array2d(dtype=wp.vec3ub), row: int, column: int, shown: wp.vec3d
) -> Range:
    """What a pixel may show by those around it; once that holds what is shown it is not widened."""
    slack = wp.float64(wp.static(LEEWAY))
    leeway = wp.vec3d(slack, slack, slack)
    result = Range()
    low = read_whole(pixels, row, column)
    high = low
    # nearly always a few of them are enough
    step = int(NEAR)
    held = bool(False)
    while step > 0 and not held:
        for down in range(-NEAR, NEAR + 1, step):
            y = wp.clamp(row + down, 0, pixels.shape[0] - 1)
            for right in range(-NEAR, NEAR + 1, step):
                value = read_whole(pixels, y, wp.clamp(column + right, 0, pixels.shape[1] - 1))
                low = wp.min(low, value)
                high = wp.max(high, value)
        result.low = wp.vec3d(low) - leeway
        result.high = wp.vec3d(high) + leeway
        inside = wp.min(wp.max(shown, result.low), result.high)
        held = farthest(inside, shown) == wp.float64(0.0)
        step = step // NEAR
    return result


@wp.func
def channel_by_channel(color: wp.vec3d) -> Bytes:
    """Code values for a block of pixels, rounded down and limited to what a byte holds."""
    values = Bytes()
    for n in range(wp.static(BLOCK)):
        for channel in range(wp.static(CHANNELS)):
            value = wp.uint8(wp.clamp(color[channel], wp.float64(0.0), wp.float64(255.0)))
            values[wp.static(CHANNELS) * n + channel] = value
    return values


@wp.func
def bytes_around(color: wp.vec3d) -> tuple[Bytes, Bytes]:
    """Bounds that hold what is near a colour for sure, with something to spare for rounding.

    No colour is farther beyond 0 or 255 than the leeway, so that bytes limit none of them.
    """
    spare = wp.float64(wp.static(LEEWAY - 2.0))
    away = wp.vec3d(spare, spare, spare)
    return channel_by_channel(color - away), channel_by_channel(color + away)


@wp.func_native("""
    const unsigned char* line = (const unsigned char*)&wp::index(pixels, row, 0);
    const unsigned char* least = (const unsigned char*)&low;
    const unsigned char* most = (const unsigned char*)&high;
    while (column < end) {
        int block_end = column + 16 < end ? column + 16 : end;
#if !defined(__CUDA_ARCH__)
        // what is left of a row is looked at together with pixels before it
        const int begin = block_end - 16;
        if (begin >= 0) {
            typedef unsigned char Bytes __attribute__((vector_size(16)));
            typedef long long Words __attribute__((vector_size(16)));
            Words out = {};
            for (int part = 0; part < 48; part += 16) {
                Bytes value, lower, upper;
                __builtin_memcpy(&value, line + 3 * begin + part, 16);
                __builtin_memcpy(&lower, least + part, 16);
                __builtin_memcpy(&upper, most + part, 16);
                out |= (Words)((value < lower) | (value > upper));
            }
            if (!(out[0] | out[1])) column = block_end;
        }
#endif
        for (; column < block_end; ++column) {
            for (int c = 0; c < 3; ++c) {
                const unsigned char value = line[3 * column + c];
                if (value < least[c] || value > most[c]) return column;
            }
        }
    }
    return end;
""")
def first_outside(
    pixels: wp.array2d(dtype=wp.vec3ub), row: int, column: int, end: int, low: Bytes, high: Bytes
) -> int:
    """The first column of a row, from one on, with a channel outside of bounds; `end` if none."""
    ...


@cache
def _color_at(model: ColorModel) -> Any:
    """A wp.func: the colour of a triangle in the middle of a pixel, within no limits."""
    exponents = model.exponents

    @wp.func
    def color_at(
        coefficients: wp.array3d(dtype=wp.float64), triangle: int, row: int, column: int
    ) -> wp.vec3d:
        """Sum up the terms."""
        x = wp.float64(column) + wp.float64(0.5)
        y = wp.float64(row) + wp.float64(0.5)
        color = wp.vec3d()
        for term in range(wp.static(len(exponents))):
            factor = wp.float64(1.0)
            for _a in range(wp.static(exponents[term][0])):
                factor *= x
            for _b in range(wp.static(exponents[term][1])):
                factor *= y
            for channel in range(3):
                color[channel] += factor * coefficients[triangle, channel, term]
        return color

    return color_at


@cache
def nearby_kernel(model: ColorModel) -> Any:
    """The kernel that looks at the pixels of triangles in a model's colours."""
    color_at = _color_at(model)

    @wp.kernel(module="unique", module_options=EXACT)
    def look_nearby(
        span: wp.array(dtype=wp.vec2i),
        # In:
        vertices: wp.array(dtype=wp.vec2d),
        triangles: wp.array(dtype=wp.vec3i),
        pixels: wp.array2d(dtype=wp.vec3ub),
        coefficients: wp.array3d(dtype=wp.float64),
        energies: wp.array(dtype=wp.float64),
        limits: wp.array3d(dtype=wp.uint8),
        # Out:
        counts_out: wp.array(dtype=int),
        changes_out: wp.array(dtype=wp.vec3d),
        places_out: wp.array2d(dtype=wp.vec2i),
        energies_out: wp.array(dtype=wp.float64),
    ):
        """Walk over one triangle's pixels, and keep what is worst in every channel."""
        triangle = span[0][0] + wp.tid()
        if triangle >= span[0][1]:
            return
        counts_out[triangle] = 0
        if energies[triangle] <= wp.float64(wp.static(0.5 * LEEWAY * LEEWAY)):
            return  # not one pixel can be that far off
        corners = triangles[triangle]
        a, b, c = vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]
        walk = walk_triangle(a, b, c, pixels.shape[0])
        count, squares = int(0), wp.float64(0.0)
        worst, changes = wp.vec3d(), wp.vec3d()
        is_told = wp.isinf(energies[triangle])
        color = color_at(coefficients, triangle, 0, 0)
        least, most = bytes_around(color)
        for channel in range(3):
            places_out[triangle, channel] = wp.vec2i()
        while walk.row + 1 < walk.end:
            walk = step_down(walk, pixels.shape[0])
            columns = columns_of(walk, pixels.shape[1])
            column = columns[0]
            while column < columns[1]:
                if wp.static(model.degree > 0):
                    color = color_at(coefficients, triangle, walk.row, column)
                elif not is_told:
                    column = first_outside(pixels, walk.row, column, columns[1], least, most)
                    if column == columns[1]:
                        break
                value = read(pixels, walk.row, column)
                if is_told:
                    squares += wp.dot(color - value, color - value)
                if farthest(color, value) > wp.float64(wp.static(LEEWAY)):
                    shown = shown_color(color, limits, triangle)
                    near = range_around(pixels, walk.row, column, shown)
                    asked = wp.min(wp.max(shown, near.low), near.high)
                    count += wp.where(farthest(shown, asked) > wp.float64(0.0), 1, 0)
                    for channel in range(3):
                        if wp.abs(asked[channel] - shown[channel]) > worst[channel]:
                            worst[channel] = wp.abs(asked[channel] - shown[channel])
                            changes[channel] = asked[channel] - color[channel]
                            places_out[triangle, channel] = wp.vec2i(column, walk.row)
                column += 1
        counts_out[triangle] = count
        changes_out[triangle] = changes
        energies_out[triangle] = wp.float64(0.5) * squares

    return look_nearby


@dataclass(frozen=True, eq=False)
class Departures:
    """Pixels of each triangle that leave the range of those around by more than `LEEWAY`."""

    counts: np.ndarray
    """How many there are, [T] int; where there is none the rest means nothing."""
    changes: np.ndarray
    """What must be added to the colour at the worst of them, channel by channel [code values],
    [T, 3]; 0 where no pixel leaves it."""
    places: np.ndarray
    """The column and the row of each of these pixels [px], [T, 3, 2] int."""
    energies: np.ndarray
    """E(T) of the colours without their limits [code value^2 px], [T]; 0 if not asked for."""


class Nearby:
    """Looks for such pixels, over the picture in a workspace.

    Args:
        workspace: Holds the picture and the mesh.
    """

    def __init__(self, workspace: Workspace) -> None:
        model = workspace.model
        self._look = TriangleLook(
            workspace,
            nearby_kernel(model),
            fixed=[workspace.pixels],
            given=[
                Column(wp.float64, (CHANNELS, model.term_count)),
                Column(wp.float64),
                Column(wp.uint8, (2, CHANNELS)),
            ],
            found=[
                Column(int),
                Column(wp.vec3d),
                Column(wp.vec2i, (CHANNELS,)),
                Column(wp.float64),
            ],
        )

    def measure(
        self, coefficients: np.ndarray, energies: np.ndarray, limits: np.ndarray
    ) -> Departures:
        """Look at the mesh as it stands.

        Args:
            coefficients: As in a snapshot, [T, 3, K].
            energies: No less than those of what is shown [code value^2 px]; 0 for triangles that
                shall not be looked at, infinite for those whose energies shall be told, [T].
            limits: Least and greatest values that are shown [code values], [T, 2, 3] uint8.
        """
        return Departures(*self._look.look(len(energies), [coefficients, energies, limits]))
