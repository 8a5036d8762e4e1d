"""The best colour of every triangle of a mesh as it stands, and the error that it leaves.

Errors are measured by a gauge of three numbers. The first divides weighted sums by the mean weight
of the picture: with weights an energy is still one of code value^2 px, and weights that are all
equal change nothing. The others tell how far the picture's pixels lie from its middle, along x and
along y [px].
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.color_model import SQUARE
from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.energy.normal_equations import centring, factorising, shifts
from warp_kernels.moments.moment_layout import MomentLayout, moment_types
from warp_kernels.moments.triangle_sides import side_sums

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


READABLE = 2.0**62
"""Below this bound a wide sum has not wrapped around, whatever rounding did to the bound."""


@cache
def fit_moments(layout: MomentLayout) -> Any:
    """A wp.func: from one triangle's moments to a `Fit`, after forward substitution.

    Without a branch, so that a processor can solve several variants at once.

    The powers 3 and 4 of a quadratic colour are read modulo 2^64 (see `moment_layout`). Seen from
    the triangle's middle the sum of w x^4 is at most R^2 times that of w x^2, which never leaves
    its integers; R is how far the picture reaches from there along x, at most its width. The same
    holds along y, and what mixes x and y lies between. A triangle for which R^2 times its sum is
    too much for 64 bits takes the linear colour. In a picture of 3840 x 2160 px that begins with
    triangles of 1,800 px across at its border and 2,500 px in its middle, with weights of 255 with
    a quarter of that; up to 1920 x 1080 px it never happens without weights.
    """
    color_type, area_type = moment_types(layout).color, moment_types(layout).area
    model, wide = layout.model, layout.wide
    terms, degree = model.term_count, model.degree
    centre_area, centre_color = centring(layout)
    factorise, matrix_type = factorising(model)
    half_type = wp.types.matrix(shape=(terms, 3), dtype=wp.float64)
    square_x, square_y = (model.area_moment(2, 0), model.area_moment(0, 2)) if degree else (0, 0)

    @wp.struct
    class Fit:
        """The least-squares colour of one triangle, after forward substitution."""

        count: wp.float64
        x: wp.float64
        y: wp.float64
        energy: wp.float64
        lower: matrix_type
        half: half_type

    @wp.func
    def fit(color_sums: color_type, area_sums: area_type, gauge: wp.vec3d) -> Fit:
        """Factorise the normal equations and substitute forward."""
        result = Fit()
        # turned inside out: the error of what it covers all the same
        total = wp.int64(area_sums[0])
        sign = wp.where(total < wp.int64(0), wp.float64(-1.0), wp.float64(1.0))
        result.count = sign * wp.float64(total)
        if wp.static(terms > 1):
            share = sign / wp.max(result.count, wp.float64(1.0))
            result.x = wp.trunc(share * wp.float64(wp.int64(area_sums[1])))
            result.y = wp.trunc(share * wp.float64(wp.int64(area_sums[2])))
        area = centre_area(area_sums, sign, result.x, result.y)
        color = centre_color(color_sums, sign, result.x, result.y)
        trusted = wp.float64(1.0)
        if wp.static(degree > 1):
            reach_x = gauge[1] + wp.abs(result.x)
            reach_y = gauge[2] + wp.abs(result.y)
            bound = wp.max(area[square_x] * reach_x * reach_x, area[square_y] * reach_y * reach_y)
            trusted = wp.where(bound < wp.float64(wp.static(READABLE)), trusted, wp.float64(0.0))
        result.lower = factorise(area, trusted)
        explained = wp.float64(0.0)
        for i in range(wp.static(terms)):
            for channel in range(3):
                value = color[4 * i + channel]
                for k in range(i):
                    value -= result.lower[i, k] * result.half[k, channel]
                result.half[i, channel] = value * result.lower[i, i]
                explained += value * result.half[i, channel]
        left = wp.max(color[wp.static(SQUARE)] - explained, wp.float64(0.0))
        result.energy = wp.float64(0.5) * left
        if wp.static(wide):
            result.energy *= gauge[0]
        return result

    return fit


@cache
def fit_kernel(layout: MomentLayout) -> Any:
    """The kernel that finds the best colours of a triangle."""
    types, model = moment_types(layout), layout.model
    color_type, area_type = types.color, types.area
    terms = model.term_count
    side_color, side_area = side_sums(layout)
    fit = fit_moments(layout)
    expansion = shifts(model.exponents)
    # vectors, for what is static but differs from turn to turn of a loop is known only once the
    # whole kernel was generated, in every process anew
    targets, sources, factors, across, down = (
        wp.types.vector(length=len(expansion), dtype=int)(*column)
        for column in zip(*expansion, strict=True)
    )

    @wp.kernel(module="unique", module_options=EXACT)
    def fit_colors(
        span: wp.array(dtype=wp.vec2i),
        # In:
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array3d(dtype=types.integer),
        area_sums: wp.array3d(dtype=types.integer),
        gauge: wp.array(dtype=wp.vec3d),
        width: int,
        height: int,
        # Out:
        coefficients_out: wp.array3d(dtype=wp.float64),
        energies_out: wp.array(dtype=wp.float64),
        counts_out: wp.array(dtype=wp.int64),
    ):
        """Gather the sums of one triangle's sides, solve, and move the origin to the image's."""
        triangle = span[0][0] + wp.tid()
        if triangle >= span[0][1]:
            return
        color = color_type()
        area = area_type()
        for n in range(3):
            color += side_color(color_sums, sides[triangle][n], 0)
            area += side_area(area_sums, sides[triangle][n], 0)
        best = fit(color, area, gauge[0])
        energies_out[triangle] = best.energy
        counts_out[triangle] = wp.int64(best.count)
        # from pixel numbers counted from the triangle's own middle to positions in the image
        x = best.x + wp.float64(width / 2) + wp.float64(0.5)
        y = best.y + wp.float64(height / 2) + wp.float64(0.5)
        for channel in range(3):
            for term in range(wp.static(terms)):
                coefficients_out[triangle, channel, term] = wp.float64(0.0)
            for back in range(wp.static(terms)):
                i = wp.static(terms - 1) - back
                for k in range(i + 1, wp.static(terms)):
                    best.half[i, channel] -= (
                        best.lower[i, i] * best.lower[k, i] * best.half[k, channel]
                    )
            for n in range(wp.static(len(expansion))):
                factor = wp.float64(factors[n])
                for _a in range(across[n]):
                    factor *= -x
                for _b in range(down[n]):
                    factor *= -y
                coefficients_out[triangle, channel, sources[n]] += (
                    factor * best.half[targets[n], channel]
                )

    return fit_colors


def record_fit(
    device: Device,
    layout: MomentLayout,
    *,
    sides: wp.array,
    color_sums: wp.array,
    area_sums: wp.array,
    gauge: wp.array,
    size: tuple[int, int],
    coefficients_out: wp.array,
    energies_out: wp.array,
    counts_out: wp.array,
) -> Phase:
    """Prepare the launch that finds the best colour of every triangle as it stands.

    Args:
        device: Where to run.
        layout: The polynomial colour and its integers.
        sides: See `record_energies`.
        color_sums: Colour moments, [E, 4 K, 1].
        area_sums: Area moments, [E, G, 1].
        gauge: 1 / mean weight, and how far pixels lie from the image's middle along x and along y
            [px], [1] vec3d.
        size: Width and height of the image [px].
        coefficients_out: Per channel the coefficients of x^a y^b with x, y positions in the image
            [code value / px^(a + b)], [T, 3, K].
        energies_out: E(T) [code value^2 px], [T].
        counts_out: Pixels covered, or the sum of their weights, [T] int64.

    Source: Lawonn & Guenther (2018), App. A.
    Deviation: where the matrix of a degree is singular the degree below it is used.
    """
    inputs = [sides, color_sums, area_sums, gauge, size[0], size[1]]
    outputs = [coefficients_out, energies_out, counts_out]
    return device.record(fit_kernel(layout), inputs, outputs)
