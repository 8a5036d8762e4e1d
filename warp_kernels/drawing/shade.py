"""One generic shader: a stack of styles, bottom to top, blended for every output pixel.

A pixel whose samples all lie in one triangle is shaded once, at its centre; a pixel on a border is
shaded once for each of its triangles, in the middle of the samples that lie in it; see `points`.
The average is of code values: the triangles on either side approximate one picture, so they are
alike, and it is in code values that their error is measured. Where strong contrasts meet, such as
ink on paper, a style gives its coverage, which mixes light; see `blend`.

A style is written for one point; the compiler makes of it a program for sixteen at a time, as long
as the loop over points stores nowhere but into variables of its own and reads single numbers.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.drawing.blend import Coat, stack_of
from warp_kernels.drawing.cross_fade import see_through
from warp_kernels.drawing.gbuffer import LEAST_ROWS
from warp_kernels.drawing.layers import LayerTables
from warp_kernels.drawing.moved import MovedTables, resting
from warp_kernels.drawing.sample_points import (
    COUNT,
    DOWN,
    LANES,
    LIST,
    PIXEL,
    RIGHT,
    ROOM,
    TRIANGLE,
    point_lister,
)
from warp_kernels.drawing.shade_pixels import pixel_kernel
from warp_kernels.drawing.store import channels_of, store_opaque, store_transparent
from warp_kernels.scene.scene import Sample, Scene, StyleParameters, extent_of

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

Values = wp.types.vector(length=ROOM, dtype=wp.float32)


@cache
def _faded_drawer(color_at: Any, samples: int, store: Any, moves: bool) -> Any:
    """A wp.func that draws those pixels of a stretch anew that something shows through."""
    look_through = see_through(color_at, samples, moves)

    @wp.func
    def draw_faded(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        moved: MovedTables,
        line: wp.array(dtype=int),
        points: wp.array(dtype=int),
        listed: wp.vec3i,
        row: int,
        column: int,
        out: wp.array(dtype=wp.uint8),
    ):
        """Point by point: a pixel on several borders is drawn as often."""
        for j in range(listed[2]):
            k = points[wp.static(PIXEL) + j]
            faded = layers.weights[points[wp.static(TRIANGLE) + j]] < 1.0
            if faded and k < listed[0]:
                seen = look_through(scene, parameters, layers, moved, line, row, column + k)
                color = seen.color
                store(out, k, color[0], color[1], color[2], seen.opacity)

    return draw_faded


@cache
def _point_reader(samples: int, moves: bool) -> Any:
    """A wp.func that gives a point of a stretch."""
    point_in = resting(moves)

    @wp.func
    def point_at(
        scene: Scene,
        moved: MovedTables,
        points: wp.array(dtype=int),
        row: int,
        column: int,
        share: float,
        j: int,
    ) -> Sample:
        """A point of a stretch that begins with a column."""
        at = column + points[wp.static(PIXEL) + j]
        middle = wp.vec2i(scene.columns[at], scene.rows[row])
        right, down = points[wp.static(RIGHT) + j], points[wp.static(DOWN) + j]
        place = wp.vec2i(middle[0] + right, middle[1] + down)
        extent = extent_of(scene, share, wp.static(samples))
        triangle = points[wp.static(TRIANGLE) + j]
        here = point_in(scene, moved, triangle, place, middle, extent)
        here.row = row
        here.column = at
        return here

    return point_at


@cache
def _stretch_drawer(coats: tuple[Coat, ...], samples: int, fades: bool) -> Any:
    """A wp.func that draws a stretch of a row."""
    channels, moves = channels_of(coats), any(coat.moves for coat in coats)
    color_at, list_points = stack_of(coats), point_lister(samples)
    store = store_opaque if channels == 3 else store_transparent
    point_at = _point_reader(samples, moves)
    draw_faded = _faded_drawer(color_at, samples, store, moves)

    @wp.func
    def draw_stretch(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        moved: MovedTables,
        line: wp.array(dtype=int),
        points: wp.array(dtype=int),
        row: int,
        column: int,
        address: wp.uint64,
    ) -> int:
        """Draw the pixels from a column on, as many as make a stretch: their number."""
        columns, width = scene.columns.shape[0], line.shape[0] / wp.static(samples)
        parts = scene.parts.ptr
        listed = list_points(line.ptr, width, column, columns - column, parts, points.ptr)
        red, green, blue, opacity = Values(), Values(), Values(), Values()
        j = int(0)
        while j < (listed[2] + wp.static(LANES - 1)) & wp.static(-LANES):
            share = float(points[wp.static(COUNT) + j]) * wp.static(1.0 / samples**2)
            here = point_at(scene, moved, points, row, column, share, j)
            color = color_at(scene, parameters, here)
            red[j] = share * (color[3] * color[0])
            green[j] = share * (color[3] * color[1])
            blue[j] = share * (color[3] * color[2])
            opacity[j] = share * color[3]
            j += 1
        for j in range(listed[1], listed[2]):
            k = points[wp.static(PIXEL) + j]
            red[k] += red[j]
            green[k] += green[j]
            blue[k] += blue[j]
            opacity[k] += opacity[j]
        out = wp.array(ptr=address, shape=(wp.static(channels) * columns,), dtype=wp.uint8)
        k = int(0)
        while k < listed[0]:
            store(out, k, red[k], green[k], blue[k], opacity[k])
            k += 1
        if wp.static(fades):
            draw_faded(scene, parameters, layers, moved, line, points, listed, row, column, out)
        return listed[0]

    return draw_stretch


@cache
def shade_kernel(coats: tuple[Coat, ...], samples: int, fades: bool) -> Any:
    """The kernel that draws a row with a stack of styles; see `record_shade`."""
    draw_stretch, channels = _stretch_drawer(coats, samples, fades), channels_of(coats)

    @wp.kernel(module="unique", module_options=EXACT)
    def shade(
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
        """Shade one row of a band of the output."""
        band_row = span[0][0] + wp.tid()
        if band_row >= span[0][1]:
            return
        # plain arrays of one row: indices are never negative, so the compiler works in blocks
        length = wp.static(samples) * triangle_of.shape[1]
        begin = wp.uint64(band_row) * wp.uint64(4)
        line = wp.array(ptr=triangle_of.ptr + begin * wp.uint64(length), shape=(length,), dtype=int)
        points = wp.array(
            ptr=points_out.ptr + begin * wp.uint64(wp.static(LIST)),
            shape=(wp.static(LIST),),
            dtype=int,
        )
        row = top + band_row
        column = int(0)
        while column < canvas_out.shape[1]:
            pixel = wp.uint64(row) * wp.uint64(canvas_out.shape[1]) + wp.uint64(column)
            address = canvas_out.ptr + pixel * wp.uint64(wp.static(channels))
            column += draw_stretch(
                scene, parameters, layers, moved, line, points, row, column, address
            )

    return shade


def shading_kernel(device: Device, coats: tuple[Coat, ...], samples: int, fades: bool) -> Any:
    """The kernel that draws a stack of styles on a device."""
    make = pixel_kernel if device.is_cuda else shade_kernel
    return make(coats, samples, fades)


def record_shade(
    device: Device,
    *,
    coats: tuple[Coat, ...],
    samples: int,
    scene: Any,
    parameters: wp.array,
    layers: Any,
    fades: bool,
    moved: Any,
    triangle_of: wp.array,
    top: int,
    flows_on: bool,
    points_out: wp.array,
    canvas_out: wp.array,
) -> Phase:
    """Prepare the launch that shades a band of the output, row by row; on a card pixel by pixel.

    Args:
        device: Where to run.
        coats: The styles, bottom to top.
        samples: Samples per output pixel, across and down each.
        scene: What shaders look at, a `Scene`.
        parameters: One `StyleParameters` per style.
        layers: What fading triangles let through, `LayerTables`.
        fades: Whether any triangle fades; else `layers` is not looked at.
        moved: Where triangles are drawn, `MovedTables`; looked at if a coat moves.
        triangle_of: Triangle of every sample of a band, see `gbuffer`.
        top: The output row with which the band begins.
        flows_on: Whether the next band has as many rows: then each part of it finds its own rows
            where it found them in this one, and no part waits for another.
        points_out: Room for the points of a stretch of every row, [rows, LIST] int32.
        canvas_out: Code values, [rows, columns, 3] if a coat is opaque, else [rows, columns, 4]
            with straight alpha.
    """
    inputs = [scene, parameters, layers, moved, triangle_of, top]
    kernel = shading_kernel(device, coats, samples, fades)
    if device.is_cuda:
        columns = canvas_out.shape[1]
        return device.record(kernel, inputs, [points_out, canvas_out], per_element=columns)
    # as the rows of the labels are spread: each thread shades those that it has filled
    return device.record(
        kernel,
        inputs,
        [points_out, canvas_out],
        smallest_part=LEAST_ROWS,
        flows_on=flows_on,
    )
