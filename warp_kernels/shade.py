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

from warp_kernels.blend import Coat, stack_of
from warp_kernels.device import Device, Phase
from warp_kernels.layers import LayerTables
from warp_kernels.points import (
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
from warp_kernels.scene import Sample, Scene, StyleParameters, sample_at
from warp_kernels.see_through import see_through

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

FLAGS = "-march=native -mprefer-vector-width=512 -mllvm=-inline-threshold=9000"
"""How a shader is compiled for a CPU: whole registers, square roots for many points at a time, and
one program of all the functions that a stack is made of."""

Values = wp.types.vector(length=ROOM, dtype=wp.float32)


@wp.func
def code_value(value: float) -> wp.uint8:
    """Round to a code value."""
    return wp.uint8(int(wp.clamp(value, 0.0, 255.0) + 0.5))


@wp.func
def write_opaque(
    red: Values, green: Values, blue: Values, opacity: Values, count: int, address: wp.uint64
):
    """Write pixels through which nothing shows."""
    out = wp.array(ptr=address, shape=(3 * count,), dtype=wp.uint8)
    k = int(0)
    while k < count:
        out[3 * k] = code_value(red[k])
        out[3 * k + 1] = code_value(green[k])
        out[3 * k + 2] = code_value(blue[k])
        k += 1


@wp.func
def write_transparent(
    red: Values, green: Values, blue: Values, opacity: Values, count: int, address: wp.uint64
):
    """Write pixels with straight alpha."""
    out = wp.array(ptr=address, shape=(4 * count,), dtype=wp.uint8)
    k = int(0)
    while k < count:
        whole = wp.max(opacity[k], 1.0e-6)
        out[4 * k] = code_value(red[k] / whole)
        out[4 * k + 1] = code_value(green[k] / whole)
        out[4 * k + 2] = code_value(blue[k] / whole)
        out[4 * k + 3] = code_value(255.0 * opacity[k])
        k += 1


@cache
def _stretch_drawer(coats: tuple[Coat, ...], samples: int, fades: bool) -> Any:
    """A wp.func that draws a stretch of a row."""
    is_opaque = any(coat.is_opaque for coat in coats)
    channels = 3 if is_opaque else 4
    write = write_opaque if is_opaque else write_transparent
    color_at, list_points = stack_of(coats), point_lister(samples)
    look_through = see_through(color_at, samples)

    @wp.func
    def draw_stretch(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        line: wp.array(dtype=int),
        points: wp.array(dtype=int),
        row: int,
        column: int,
        out: wp.uint64,
    ) -> int:
        """Draw the pixels from a column on, as many as make a stretch: their number."""
        width = line.shape[0] / wp.static(samples)
        columns = scene.columns.shape[0]
        found = list_points(line.ptr, width, column, columns - column, scene.parts.ptr, points.ptr)
        red = Values()
        green = Values()
        blue = Values()
        opacity = Values()
        y = scene.rows[row]
        j = int(0)
        end = (found[2] + wp.static(LANES - 1)) & wp.static(-LANES)
        while j < end:
            at = column + points[wp.static(PIXEL) + j]
            x = scene.columns[at] + points[wp.static(RIGHT) + j]
            place = wp.vec2i(x, y + points[wp.static(DOWN) + j])
            share = float(points[wp.static(COUNT) + j]) * wp.static(1.0 / samples**2)
            triangle = points[wp.static(TRIANGLE) + j]
            here = sample_at(scene, triangle, place, share, wp.static(samples))
            here.row = row
            here.column = at
            color = color_at(scene, parameters, here)
            red[j] = share * (color[3] * color[0])
            green[j] = share * (color[3] * color[1])
            blue[j] = share * (color[3] * color[2])
            if wp.static(not is_opaque):
                opacity[j] = share * color[3]
            j += 1
        j = found[1]
        while j < found[2]:
            k = points[wp.static(PIXEL) + j]
            red[k] += red[j]
            green[k] += green[j]
            blue[k] += blue[j]
            if wp.static(not is_opaque):
                opacity[k] += opacity[j]
            j += 1
        if wp.static(fades):
            j = int(0)
            while j < found[2]:
                # a pixel that is on several borders is looked at as often
                if layers.weights[points[wp.static(TRIANGLE) + j]] < 1.0:
                    k = points[wp.static(PIXEL) + j]
                    seen = look_through(scene, parameters, layers, line, row, column + k)
                    red[k] = seen.color[0]
                    green[k] = seen.color[1]
                    blue[k] = seen.color[2]
                    opacity[k] = seen.opacity
                j += 1
        first = wp.uint64(row) * wp.uint64(columns) + wp.uint64(column)
        address = out + first * wp.uint64(wp.static(channels))
        write(red, green, blue, opacity, found[0], address)
        return found[0]

    return draw_stretch


@cache
def _shade_kernel(coats: tuple[Coat, ...], samples: int, fades: bool) -> Any:
    draw_stretch = _stretch_drawer(coats, samples, fades)

    @wp.kernel(enable_backward=False, module="unique", module_options={"cpu_compiler_flags": FLAGS})
    def shade(
        span: wp.array(dtype=wp.vec2i),
        # In:
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
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
        line = wp.array(
            ptr=triangle_of.ptr + begin * wp.uint64(length), shape=(length,), dtype=int
        )
        points = wp.array(
            ptr=points_out.ptr + begin * wp.uint64(wp.static(LIST)),
            shape=(wp.static(LIST),),
            dtype=int,
        )
        row = top + band_row
        column = int(0)
        while column < canvas_out.shape[1]:
            column += draw_stretch(
                scene, parameters, layers, line, points, row, column, canvas_out.ptr
            )

    return shade


def record_shade(
    device: Device,
    *,
    coats: tuple[Coat, ...],
    samples: int,
    scene: Any,
    parameters: wp.array,
    layers: Any,
    fades: bool,
    triangle_of: wp.array,
    top: int,
    points_out: wp.array,
    canvas_out: wp.array,
) -> Phase:
    """Prepare the launch that shades a band of the output, row by row.

    Args:
        device: Where to run.
        coats: The styles, bottom to top.
        samples: Samples per output pixel, across and down each.
        scene: What shaders look at, a `Scene`.
        parameters: One `StyleParameters` per style.
        layers: What fading triangles let through, `LayerTables`.
        fades: Whether any triangle fades; else `layers` is not looked at.
        triangle_of: Triangle of every sample of a band, see `gbuffer`.
        top: The output row with which the band begins.
        points_out: Room for the points of a stretch of every row, [rows, LIST] int32.
        canvas_out: Code values, [rows, columns, 3] if a coat is opaque, else [rows, columns, 4]
            with straight alpha.
    """
    inputs = [scene, parameters, layers, triangle_of, top]
    kernel = _shade_kernel(coats, samples, fades)
    return device.record(kernel, inputs, [points_out, canvas_out], flows_on=True)
