"""The best colour of every triangle of a mesh as it stands, and the error that it leaves."""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.color_model import SQUARE, ColorModel
from warp_kernels.device import Device, Phase
from warp_kernels.moments import moment_types
from warp_kernels.normal_equations import centring, factorising, float_types, shifts
from warp_kernels.sides import side_sums

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def fit_moments(model: ColorModel) -> Any:
    """A wp.func: from one triangle's moments to a `Fit`, after forward substitution.

    Without a branch, so that a processor can solve several variants at once. Sums stay below
    2^53 (see `check_size`): as float64 they and their shifts to another origin are exact.
    """
    color_type, area_type = moment_types(model).color, moment_types(model).area
    float_color_type, float_area_type = float_types(model)
    terms = model.term_count
    centre_area, centre_color = centring(model)
    factorise, matrix_type = factorising(model)
    half_type = wp.types.matrix(shape=(terms, 3), dtype=wp.float64)

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
    def fit(color_sums: color_type, area_sums: area_type) -> Fit:
        """Factorise the normal equations and substitute forward."""
        result = Fit()
        # turned inside out: the error of what it covers all the same
        sign = wp.where(area_sums[0] < wp.int64(0), wp.float64(-1.0), wp.float64(1.0))
        color = float_color_type()
        for n in range(wp.static(4 * terms)):
            color[n] = sign * wp.float64(color_sums[n])
        area = float_area_type()
        for n in range(wp.static(model.area_count)):
            area[n] = sign * wp.float64(area_sums[n])
        result.count = area[0]
        if wp.static(terms > 1):
            count = wp.max(area[0], wp.float64(1.0))
            result.x = wp.trunc(area[1] / count)
            result.y = wp.trunc(area[2] / count)
            area = centre_area(area, result.x, result.y)
            color = centre_color(color, result.x, result.y)
        result.lower = factorise(area)
        explained = wp.float64(0.0)
        for i in range(wp.static(terms)):
            pivot = result.lower[i, i]
            some = pivot > wp.float64(0.0)
            divisor = wp.where(some, pivot, wp.float64(1.0))
            for channel in range(3):
                value = color[4 * i + channel]
                for k in range(i):
                    value -= result.lower[i, k] * result.half[k, channel]
                value = wp.where(some, value / divisor, wp.float64(0.0))
                result.half[i, channel] = value
                explained += value * value
        left = wp.max(color[wp.static(SQUARE)] - explained, wp.float64(0.0))
        result.energy = wp.float64(0.5) * left
        return result

    return fit


@cache
def _fit_kernel(model: ColorModel) -> Any:
    types = moment_types(model)
    color_type, area_type = types.color, types.area
    terms = model.term_count
    side_color, side_area = side_sums(model)
    fit = fit_moments(model)
    expansion = shifts(model.exponents)

    @wp.kernel(enable_backward=False, module="unique")
    def fit_colors(
        span: wp.array(dtype=wp.vec2i),
        # In:
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array2d(dtype=color_type),
        area_sums: wp.array2d(dtype=area_type),
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
        best = fit(color, area)
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
                if best.lower[i, i] > wp.float64(0.0):
                    value = best.half[i, channel]
                    for k in range(i + 1, wp.static(terms)):
                        value -= best.lower[k, i] * best.half[k, channel]
                    best.half[i, channel] = value / best.lower[i, i]
            for n in range(wp.static(len(expansion))):
                factor = wp.float64(wp.static(float(expansion[n][2])))
                for _a in range(wp.static(expansion[n][3])):
                    factor *= -x
                for _b in range(wp.static(expansion[n][4])):
                    factor *= -y
                coefficients_out[triangle, channel, wp.static(expansion[n][1])] += (
                    factor * best.half[wp.static(expansion[n][0]), channel]
                )

    return fit_colors


def record_fit(
    device: Device,
    model: ColorModel,
    *,
    sides: wp.array,
    color_sums: wp.array,
    area_sums: wp.array,
    size: tuple[int, int],
    coefficients_out: wp.array,
    energies_out: wp.array,
    counts_out: wp.array,
) -> Phase:
    """Prepare the launch that finds the best colour of every triangle as it stands.

    Args:
        device: Where to run.
        model: The polynomial colour.
        sides: See `record_energies`.
        color_sums: Colour moments, [E, 1].
        area_sums: Area moments, [E, 1].
        size: Width and height of the image [px].
        coefficients_out: Per channel the coefficients of x^a y^b with x, y positions in the image
            [code value / px^(a + b)], [T, 3, K].
        energies_out: E(T) [code value^2 px], [T].
        counts_out: Pixels covered, [T] int64.

    Source: Lawonn & Guenther (2018), App. A.
    """
    inputs = [sides, color_sums, area_sums, size[0], size[1]]
    outputs = [coefficients_out, energies_out, counts_out]
    return device.record(_fit_kernel(model), inputs, outputs)
