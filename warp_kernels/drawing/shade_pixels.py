"""Shading on a card: a thread for every pixel, where the CPU has one for every row.

The same sums in the same order as `shade`, so the same bits: a pixel within one triangle is one
point, one on a border a point for each of its triangles, that of its first sample first.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device.exact import EXACT
from warp_kernels.drawing.blend import Coat, stack_of
from warp_kernels.drawing.cross_fade import see_through
from warp_kernels.drawing.layers import LayerTables
from warp_kernels.drawing.moved import MovedTables, resting
from warp_kernels.drawing.store import channels_of, store_opaque, store_transparent
from warp_kernels.scene.scene import Scene, StyleParameters, extent_of


@cache
def _parts_reader(samples: int) -> tuple[Any, Any]:
    """wp.funcs: whether a pixel lies on a border, and which of its samples lie in a triangle."""

    @wp.func
    def is_border(line: wp.array(dtype=int), width: int, first: int) -> bool:
        """Whether its upper samples differ from each other, or from the lowest below them.

        A triangle that holds the outermost samples holds those between, as it is convex; where
        moved ones overlap the CPU takes it to do so, too.
        """
        differing = int(0)
        lowest = first + wp.static(samples - 1) * width
        for k in range(wp.static(samples)):
            differing |= line[first + k] ^ line[first]
            differing |= line[first + k] ^ line[lowest + k]
        return differing != 0

    @wp.func
    def samples_in(line: wp.array(dtype=int), width: int, first: int, triangle: int) -> int:
        """Its samples that lie in a triangle, as bits."""
        found = int(0)
        for k in range(wp.static(samples * samples)):
            other = line[(k // samples) * width + first + k % samples]
            found += wp.where(other == triangle, 1 << k, 0)
        return found

    return is_border, samples_in


@cache
def pixel_kernel(coats: tuple[Coat, ...], samples: int, fades: bool) -> Any:
    """The kernel that draws a pixel with a stack of styles; its parameters are those of `shade`."""
    channels, moves = channels_of(coats), any(coat.moves for coat in coats)
    color_at, point_in = stack_of(coats), resting(moves)
    store = store_opaque if channels == 3 else store_transparent
    look_through = see_through(color_at, samples, moves)
    is_border, samples_in = _parts_reader(samples)
    every = (1 << samples * samples) - 1

    @wp.kernel(module="unique", module_options=EXACT)
    def shade_pixels(
        span: wp.array(dtype=wp.vec2i),
        # In:
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        moved: MovedTables,
        triangle_of: wp.array2d(dtype=int),
        top: int,
        # Out:
        points_out: wp.array2d(dtype=int),
        canvas_out: wp.array3d(dtype=wp.uint8),
    ):
        """Shade one pixel of a band of the output."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        columns = canvas_out.shape[1]
        band_row = number / columns
        column = number - band_row * columns
        row = top + band_row
        width = triangle_of.shape[1]
        length = wp.static(samples) * width
        begin = wp.uint64(band_row) * wp.uint64(4) * wp.uint64(length)
        line = wp.array(ptr=triangle_of.ptr + begin, shape=(length,), dtype=int)
        first = column * wp.static(samples)
        middle = wp.vec2i(scene.columns[column], scene.rows[row])
        red, green, blue, opacity = float(0.0), float(0.0), float(0.0), float(0.0)
        faded = bool(False)
        whole = not is_border(line, width, first)
        left = int(wp.static(every))
        while left != 0:
            k = int(0)
            while (left >> k) & 1 == 0:
                k += 1
            triangle = line[(k / wp.static(samples)) * width + first + k % wp.static(samples)]
            own = left
            if not whole:
                own = left & samples_in(line, width, first, triangle)
            left = left ^ own
            share = float(scene.parts[own, 2]) * wp.static(1.0 / samples**2)
            place = middle + wp.vec2i(scene.parts[own, 0], scene.parts[own, 1])
            extent = extent_of(scene, share, wp.static(samples))
            here = point_in(scene, moved, triangle, place, middle, extent)
            here.row = row
            here.column = column
            color = color_at(scene, parameters, here)
            red += share * (color[3] * color[0])
            green += share * (color[3] * color[1])
            blue += share * (color[3] * color[2])
            opacity += share * color[3]
            if wp.static(fades):
                faded = faded or layers.weights[triangle] < 1.0
        address = canvas_out.ptr + wp.uint64(row) * wp.uint64(wp.static(channels) * columns)
        out = wp.array(ptr=address, shape=(wp.static(channels) * columns,), dtype=wp.uint8)
        if wp.static(fades):  # noqa: SIM102 - what is not compiled is not looked at
            if faded:
                seen = look_through(scene, parameters, layers, moved, line, row, column)
                red, green, blue = seen.color[0], seen.color[1], seen.color[2]
                opacity = seen.opacity
        store(out, column, red, green, blue, opacity)

    return shade_pixels
