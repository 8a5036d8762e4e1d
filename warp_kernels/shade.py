"""One generic shader: a stack of styles, bottom to top, blended for every output pixel.

A pixel whose samples all lie in one triangle is shaded once, at its centre; a pixel on a border,
or on one that is seen through a triangle that fades in, is shaded at every sample and averaged.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device import Device, Phase
from warp_kernels.layers import LayerTables, fading_look, opaque_look
from warp_kernels.scene import Sample, Scene, StyleParameters

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def _stack(shaders: tuple[Any, ...]) -> Any:
    """A wp.func that blends the layers of some style shaders, the last on top."""
    if not shaders:

        @wp.func
        def paper(
            scene: Scene, parameters: wp.array(dtype=StyleParameters), sample: Sample
        ) -> wp.vec3f:
            """Nothing drawn: black."""
            return wp.vec3f()

        return paper
    below, top, layer = _stack(shaders[:-1]), shaders[-1], len(shaders) - 1

    @wp.func
    def blended(
        scene: Scene, parameters: wp.array(dtype=StyleParameters), sample: Sample
    ) -> wp.vec3f:
        """The layers below, and the top one over them by its opacity."""
        under = below(scene, parameters, sample)
        over = top(scene, parameters[wp.static(layer)], sample)
        color = wp.vec3f(over[0], over[1], over[2])
        return under + over[3] * (color - under)

    return blended


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
def to_code_values(color: wp.vec3f) -> wp.vec3ub:
    """Round a colour to code values."""
    return wp.vec3ub(
        wp.uint8(int(wp.clamp(color[0], 0.0, 255.0) + 0.5)),
        wp.uint8(int(wp.clamp(color[1], 0.0, 255.0) + 0.5)),
        wp.uint8(int(wp.clamp(color[2], 0.0, 255.0) + 0.5)),
    )


@cache
def _shade_kernel(shaders: tuple[Any, ...], samples: int, fades: bool) -> Any:
    color_at = _stack(shaders)
    look = fading_look(color_at) if fades else opaque_look(color_at)

    @wp.kernel(enable_backward=False, module="unique")
    def shade(
        span: wp.array(dtype=wp.vec2i),
        # In:
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        triangle_of: wp.array2d(dtype=int),
        picture_per_sample: wp.vec2f,
        top: int,
        # Out:
        canvas_out: wp.array2d(dtype=wp.vec3ub),
    ):
        """Shade one row of a band of the output."""
        band_row = span[0][0] + wp.tid()
        if band_row >= span[0][1]:
            return
        row = top + band_row
        first_row = row * wp.static(samples)
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
        near = wp.length(picture_per_sample) * wp.static(0.625 * samples)
        column = int(0)
        while column < canvas_out.shape[1]:
            first = column * wp.static(samples)
            here.column = column
            here.triangle = line[first]
            color = wp.vec3f()
            clear = float(0.0)
            if is_whole(line, first, width, wp.static(samples - 1)):
                centre = wp.static(0.5 * samples)
                at = wp.vec2f(float(first) + centre, float(first_row) + centre)
                here.position = wp.cw_mul(at, picture_per_sample)
                seen = look(scene, parameters, layers, here)
                color = wp.vec3f(seen[0], seen[1], seen[2])
                clear = seen[3]
            if clear < near:
                color = wp.vec3f()
                for i in range(wp.static(samples)):
                    for j in range(wp.static(samples)):
                        here.triangle = line[i * width + first + j]
                        at = wp.vec2f(float(first + j) + 0.5, float(first_row + i) + 0.5)
                        here.position = wp.cw_mul(at, picture_per_sample)
                        seen = look(scene, parameters, layers, here)
                        color += wp.vec3f(seen[0], seen[1], seen[2])
                color = color * wp.static(1.0 / (samples * samples))
            canvas_out[row, column] = to_code_values(color)
            column += 1

    return shade


def record_shade(
    device: Device,
    *,
    shaders: tuple[Any, ...],
    samples: int,
    scene: Any,
    parameters: wp.array,
    layers: Any,
    fades: bool,
    triangle_of: wp.array,
    picture_per_sample: tuple[float, float],
    top: int,
    canvas_out: wp.array,
) -> Phase:
    """Prepare the launch that shades a band of the output, row by row.

    Args:
        device: Where to run.
        shaders: The styles' wp.funcs `(Scene, StyleParameters, Sample) -> vec4f` of colour
            [code values] and opacity [0..1], bottom to top.
        samples: Samples per output pixel, across and down each.
        scene: What shaders look at, a `Scene`.
        parameters: One `StyleParameters` per shader.
        layers: What fading triangles let through, `LayerTables`.
        fades: Whether any triangle fades; else `layers` is not looked at.
        triangle_of: Triangle of every sample of a band, see `gbuffer`.
        picture_per_sample: Size of a sample in the source picture [px], across and down.
        top: The output row with which the band begins.
        canvas_out: Code values, [rows, columns] vec3ub.
    """
    inputs = [scene, parameters, layers, triangle_of, wp.vec2f(*picture_per_sample), top]
    return device.record(_shade_kernel(shaders, samples, fades), inputs, [canvas_out])
