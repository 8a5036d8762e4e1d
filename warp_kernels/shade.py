"""One generic shader: a stack of styles, bottom to top, blended for every output pixel.

A pixel whose samples all lie in one triangle is shaded once, at its centre; a pixel on a border is
shaded once for each of its triangles, in the middle of the samples that lie in it, and where one
fades in, which hides borders beneath, at every sample.
The average is of code values: the triangles on either side approximate one picture, so they are
alike, and it is in code values that their error is measured. Where strong contrasts meet, such as
ink on paper, a style gives its coverage, which mixes light; see `blend`.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.blend import Coat, stack_of
from warp_kernels.device import Device, Phase
from warp_kernels.layers import LayerTables, Seen, fading_look, opaque_look
from warp_kernels.scene import Sample, Scene, StyleParameters, offset_of

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def is_whole(line: wp.array(dtype=int), first: int, width: int, last: int) -> bool:
    """Whether one triangle holds all samples of a pixel.

    One that holds the four outermost samples holds those between: it is convex.

    Args:
        line: Triangles of the samples of a row of pixels.
        first: Place of the pixel's first sample.
        width: Samples in a row.
        last: Samples of a pixel, across and down each, less one.
    """
    triangle = line[first]
    below = first + last * width
    differing = triangle ^ line[first + last]
    differing = differing | (triangle ^ line[below])
    differing = differing | (triangle ^ line[below + last])
    return differing == 0


@wp.func
def code_value(value: float) -> wp.uint8:
    """Round to a code value."""
    return wp.uint8(int(wp.clamp(value, 0.0, 255.0) + 0.5))


@wp.func
def opaque_pixel(seen: Seen) -> wp.vec3ub:
    """Code values of a pixel through which nothing shows."""
    color = seen.color
    return wp.vec3ub(code_value(color[0]), code_value(color[1]), code_value(color[2]))


@wp.func
def transparent_pixel(seen: Seen) -> wp.vec4ub:
    """Code values of a pixel with straight alpha."""
    color = seen.color / wp.max(seen.opacity, 1.0e-6)
    return wp.vec4ub(
        code_value(color[0]),
        code_value(color[1]),
        code_value(color[2]),
        code_value(255.0 * seen.opacity),
    )


@wp.func
def sample_at(scene: Scene, pixel: Sample, triangle: int, x: int, y: int) -> Sample:
    """A point of a pixel, in one of the triangles there, at a place [2^-16 px]."""
    here = Sample()
    here.row = pixel.row
    here.column = pixel.column
    here.triangle = triangle
    here.place = wp.vec2i(x, y)
    here.offset = offset_of(here.place, scene.anchors[triangle])
    return here


@cache
def _each_triangle(look: Any, samples: int) -> Any:
    """A wp.func that sees every triangle of a pixel once, in the middle of its samples."""

    @wp.func
    def mixed(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        line: wp.array(dtype=int),
        columns: wp.array(dtype=int),
        rows: wp.array(dtype=int),
        pixel: Sample,
    ) -> Seen:
        """The mean over the triangles by their numbers of samples."""
        width = line.shape[0] / wp.static(samples)
        first = pixel.column * wp.static(samples)
        top = pixel.row * wp.static(samples)
        seen = Seen()
        left = int(wp.static((1 << samples * samples) - 1))
        while left != 0:
            count = int(0)
            triangle = int(0)
            x = int(0)
            y = int(0)
            for i in range(wp.static(samples)):
                for j in range(wp.static(samples)):
                    bit = wp.static(1) << (i * wp.static(samples) + j)
                    other = line[i * width + first + j]
                    if count == 0 and (left & bit) != 0:
                        triangle = other
                    if (left & bit) != 0 and other == triangle:
                        left = left ^ bit
                        count += 1
                        # from the first sample: sums of whole places would not fit
                        x += columns[first + j] - columns[first]
                        y += rows[top + i] - rows[top]
            here = sample_at(
                scene, pixel, triangle, columns[first] + x / count, rows[top] + y / count
            )
            part = look(scene, parameters, layers, here)
            seen.color += float(count) * part.color
            seen.opacity += float(count) * part.opacity
        seen.color = seen.color * wp.static(1.0 / (samples * samples))
        seen.opacity = seen.opacity * wp.static(1.0 / (samples * samples))
        return seen

    return mixed


@cache
def _each_sample(look: Any, samples: int) -> Any:
    """A wp.func that sees every sample of a pixel: beneath one triangle there may be several."""

    @wp.func
    def mixed(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        line: wp.array(dtype=int),
        columns: wp.array(dtype=int),
        rows: wp.array(dtype=int),
        pixel: Sample,
    ) -> Seen:
        """The mean over the samples."""
        width = line.shape[0] / wp.static(samples)
        first = pixel.column * wp.static(samples)
        top = pixel.row * wp.static(samples)
        seen = Seen()
        number = int(0)
        while number < wp.static(samples * samples):
            i = number / wp.static(samples)
            j = number % wp.static(samples)
            triangle = line[i * width + first + j]
            here = sample_at(scene, pixel, triangle, columns[first + j], rows[top + i])
            part = look(scene, parameters, layers, here)
            seen.color += part.color
            seen.opacity += part.opacity
            number += 1
        seen.color = seen.color * wp.static(1.0 / (samples * samples))
        seen.opacity = seen.opacity * wp.static(1.0 / (samples * samples))
        return seen

    return mixed


@cache
def _shade_kernel(coats: tuple[Coat, ...], samples: int, fades: bool) -> Any:
    is_opaque = any(coat.is_opaque for coat in coats)
    pixel_of = opaque_pixel if is_opaque else transparent_pixel
    pixel_type = wp.vec3ub if is_opaque else wp.vec4ub
    color_at = stack_of(coats)
    look = fading_look(color_at) if fades else opaque_look(color_at)
    mixed = _each_sample(look, samples) if fades else _each_triangle(look, samples)

    @wp.kernel(enable_backward=False, module="unique")
    def shade(
        span: wp.array(dtype=wp.vec2i),
        # In:
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        triangle_of: wp.array2d(dtype=int),
        sample_columns: wp.array(dtype=int),
        sample_rows: wp.array(dtype=int),
        top: int,
        # Out:
        canvas_out: wp.array2d(dtype=pixel_type),
    ):
        """Shade one row of a band of the output."""
        band_row = span[0][0] + wp.tid()
        if band_row >= span[0][1]:
            return
        row = top + band_row
        width = triangle_of.shape[1]
        # a plain array of the row's samples: its index is never negative and its stride is known
        pitch = wp.uint64(width) * wp.uint64(wp.static(4 * samples))
        line = wp.array(
            ptr=triangle_of.ptr + wp.uint64(band_row) * pitch,
            shape=(wp.static(samples) * width,),
            dtype=int,
        )
        here = Sample()
        here.row = row
        # as far as a pixel's corner is from its centre, also where a map stretches by a quarter
        near = scene.pixel * 0.884
        column = int(0)
        while column < canvas_out.shape[1]:
            first = column * wp.static(samples)
            here.column = column
            here.triangle = line[first]
            seen = Seen()
            if is_whole(line, first, width, wp.static(samples - 1)):
                here.place = wp.vec2i(scene.columns[column], scene.rows[row])
                here.offset = offset_of(here.place, scene.anchors[here.triangle])
                seen = look(scene, parameters, layers, here)
            if seen.clear < near:
                seen = mixed(scene, parameters, layers, line, sample_columns, sample_rows, here)
            canvas_out[row, column] = pixel_of(seen)
            column += 1

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
    sample_columns: wp.array,
    sample_rows: wp.array,
    top: int,
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
        sample_columns: Places of the samples of a row [2^-16 px], [columns times samples].
        sample_rows: The same down, [rows times samples].
        top: The output row with which the band begins.
        canvas_out: Code values, [rows, columns]: vec3ub if a coat is opaque, else vec4ub with
            straight alpha.
    """
    inputs = [scene, parameters, layers, triangle_of, sample_columns, sample_rows, top]
    return device.record(_shade_kernel(coats, samples, fades), inputs, [canvas_out])
