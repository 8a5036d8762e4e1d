"""One generic shader: a stack of styles, bottom to top, blended for every output pixel.

A pixel whose samples all lie in one triangle is shaded once, at its centre; a pixel on a border is
shaded once for each of its triangles, in the middle of the samples that lie in it. Where one fades
in and a border is near beneath, the pixel is shaded at every sample.
The average is of code values: the triangles on either side approximate one picture, so they are
alike, and it is in code values that their error is measured. Where strong contrasts meet, such as
ink on paper, a style gives its coverage, which mixes light; see `blend`.
"""

from functools import cache
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.blend import Coat, stack_of
from warp_kernels.device import Device, Phase
from warp_kernels.layers import LayerTables, Seen, fading_look, opaque_look
from warp_kernels.scene import FAR, FIXED, Sample, Scene, StyleParameters, offset_of

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


CAUTION = wp.constant(0.98)
"""Part of a distance that is relied on: places are rounded."""


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


def parts_of_a_pixel(samples: int) -> np.ndarray:
    """What every set of a pixel's samples is, by the set as bits, sample 0 the lowest.

    Args:
        samples: Samples of a pixel, across and down each.

    Returns:
        `Scene.parts`, [2^(samples^2), 4]: number of samples, their middle from the centre of the
        pixel, right and down [samples], and the number of the first one.
    """
    sets = np.arange(1 << samples**2)
    bits = (sets[:, None] >> np.arange(samples**2)) & 1
    counts = bits.sum(axis=1)
    down, right = np.divmod(np.arange(samples**2), samples) - np.array([[(samples - 1) / 2]])
    middles = bits @ np.stack([right, down], axis=1) / np.maximum(counts, 1)[:, None]
    return np.column_stack([counts, middles, bits.argmax(axis=1)])


@wp.func
def sample_of(pixel: Sample, triangle: int, anchor: wp.vec2i, step: wp.vec2f) -> Sample:
    """A point of a pixel, a step from its centre [2^-16 px], in a triangle with this anchor."""
    here = Sample()
    here.triangle = triangle
    here.place = pixel.place + wp.vec2i(int(wp.rint(step[0])), int(wp.rint(step[1])))
    here.offset = offset_of(here.place, anchor)
    here.row = pixel.row
    here.column = pixel.column
    return here


@cache
def _even_look(look: Any, samples: int) -> Any:
    """A wp.func that sees a pixel where every triangle has one colour: a mean of samples."""

    @wp.func
    def pixel_look(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        line: wp.array(dtype=int),
        pixel: Sample,
    ) -> Seen:
        """The mean over the samples, or one look where they all lie in one triangle."""
        first = pixel.column * wp.static(samples)
        width = line.shape[0] / wp.static(samples)
        here = Sample()
        here.triangle = line[first]
        if is_whole(line, first, width, wp.static(samples - 1)):
            even = look(scene, parameters, layers, here)
            even.calm = 0.0
            return even
        seen = Seen()
        for i in range(wp.static(samples)):
            for j in range(wp.static(samples)):
                here.triangle = line[i * width + first + j]
                part = look(scene, parameters, layers, here)
                seen.color += part.color
                seen.opacity += part.opacity
        seen.color = seen.color * wp.static(1.0 / (samples * samples))
        seen.opacity = seen.opacity * wp.static(1.0 / (samples * samples))
        return seen

    return pixel_look


@cache
def _pixel_look(look: Any, samples: int, fades: bool) -> Any:
    """A wp.func that sees a pixel: as a whole, triangle by triangle or sample by sample.

    Warp hands a scene over by value. Where a function is called at one place only the compiler
    puts it there and nothing is copied: so there is one loop for all three cases.
    """
    every = (1 << samples * samples) - 1

    @wp.func
    def samples_in(line: wp.array(dtype=int), first: int, triangle: int) -> int:
        """The samples of a pixel that lie in a triangle, as bits; without a branch."""
        width = line.shape[0] / wp.static(samples)
        found = int(0)
        for k in range(wp.static(samples * samples)):
            other = line[(k // samples) * width + first + k % samples]
            found += wp.where(other == triangle, 1 << k, 0)
        return found

    @wp.func
    def pixel_look(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        line: wp.array(dtype=int),
        pixel: Sample,
    ) -> Seen:
        """The mean over the parts of the pixel."""
        first = pixel.column * wp.static(samples)
        width = line.shape[0] / wp.static(samples)
        whole = is_whole(line, first, width, wp.static(samples - 1))
        by_sample = bool(False)
        # as far as a pixel's corner is from its centre, also where a map stretches by a quarter
        near = 0.884 * pixel.extent
        seen = Seen()
        seen.clear = FAR
        left = int(wp.static(every))
        while left != 0:
            triangle = line[first]
            share = float(1.0)
            step = wp.vec2f()
            own = left
            if by_sample or not whole:
                k = int(scene.parts[left][3])
                triangle = line[(k / wp.static(samples)) * width + first + k % wp.static(samples)]
                own = wp.where(by_sample, left & -left, left & samples_in(line, first, triangle))
                part = scene.parts[own]
                share = part[0] * wp.static(1.0 / samples**2)
                step = wp.cw_mul(wp.vec2f(part[1], part[2]), scene.sample_size)
            left = left ^ own
            here = sample_of(pixel, triangle, scene.anchors[triangle], step)
            # as wide as a strip of so many samples beside the border
            here.extent = pixel.extent * wp.max(share, wp.static(1.0 / samples))
            found = look(scene, parameters, layers, here)
            seen.color += share * found.color
            seen.opacity += share * found.opacity
            seen.clear = wp.min(seen.clear, found.clear)
            seen.calm = wp.where(whole, found.calm, 0.0)
            if wp.static(fades) and left == 0 and not by_sample and seen.clear < near:
                by_sample = True
                left = wp.static(every)
                seen = Seen()
        return seen

    return pixel_look


@cache
def _shade_kernel(coats: tuple[Coat, ...], samples: int, fades: bool) -> Any:
    is_opaque = any(coat.is_opaque for coat in coats)
    pixel_of = opaque_pixel if is_opaque else transparent_pixel
    pixel_type = wp.vec3ub if is_opaque else wp.vec4ub
    color_at = stack_of(coats)
    look = fading_look(color_at) if fades else opaque_look(color_at)
    is_even = all(coat.is_even for coat in coats) and not fades
    pixel_look = _even_look(look, samples) if is_even else _pixel_look(look, samples, fades)

    @wp.kernel(enable_backward=False, module="unique")
    def shade(
        span: wp.array(dtype=wp.vec2i),
        # In:
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        triangle_of: wp.array2d(dtype=int),
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
        pixel = Sample()
        pixel.row = row
        pixel.extent = scene.pixel
        y = scene.rows[row]
        calm_share = CAUTION * wp.static(FIXED / samples) / scene.sample_size[0]
        column = int(0)
        while column < canvas_out.shape[1]:
            pixel.column = column
            pixel.place = wp.vec2i(scene.columns[column], y)
            seen = pixel_look(scene, parameters, layers, line, pixel)
            color = pixel_of(seen)
            canvas_out[row, column] = color
            column += 1
            # the pixels up to here lie in the same triangle and look the same
            alike = wp.min(column + int(seen.calm * calm_share), canvas_out.shape[1])
            while column < alike:
                canvas_out[row, column] = color
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
        top: The output row with which the band begins.
        canvas_out: Code values, [rows, columns]: vec3ub if a coat is opaque, else vec4ub with
            straight alpha.
    """
    inputs = [scene, parameters, layers, triangle_of, top]
    return device.record(_shade_kernel(coats, samples, fades), inputs, [canvas_out])
