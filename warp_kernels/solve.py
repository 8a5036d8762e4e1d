"""From moments to the best colour of every triangle and the error that it leaves.

The normal equations of Eq. 15 share one matrix between the channels: one Cholesky factorisation,
and the energy follows from its forward substitution alone, without a second pass over pixels.
"""

from functools import cache
from math import comb
from typing import Any

import warp as wp

from warp_kernels.color_model import SQUARE, ColorModel
from warp_kernels.device import Device, Phase
from warp_kernels.moments import moment_types
from warp_kernels.variants import TRIANGLE_VARIANTS, edge_version

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

SINGULAR = 1e-9
"""A pivot this small beside its diagonal entry makes the matrix singular: the constant is used."""

SMALLEST_PART = 256
"""Triangles whose variants take about as long as waking up a second thread."""

SUMS = ("edges", "fragments")
"""The two ways to sum, see `edge_moments` and `fragments`."""


@cache
def _side_sums(model: ColorModel) -> tuple[Any, Any]:
    """Two wp.funcs: what a version of an edge adds to the sums of a triangle beside it."""
    types = moment_types(model)
    color_type, area_type = types.color, types.area

    # (n ^ -1) + 1 is -n: a product of 64-bit integers would cost several times more
    @wp.func
    def side_color(sums: wp.array2d(dtype=color_type), side: int, version: int) -> color_type:
        """Colour moments with the sign of the side."""
        color = sums[side >> 1, version]
        reversed_edge = wp.int64(side & 1)
        for n in range(wp.static(4 * model.term_count)):
            color[n] = (color[n] ^ -reversed_edge) + reversed_edge
        return color

    @wp.func
    def side_area(sums: wp.array2d(dtype=area_type), side: int, version: int) -> area_type:
        """Area moments with the sign of the side."""
        area = sums[side >> 1, version]
        reversed_edge = wp.int64(side & 1)
        for n in range(wp.static(model.area_count)):
            area[n] = (area[n] ^ -reversed_edge) + reversed_edge
        return area

    return side_color, side_area


@cache
def _float_types(model: ColorModel) -> tuple[Any, Any]:
    """The vector types of colour and area moments in float64."""
    color = wp.types.vector(length=4 * model.term_count, dtype=wp.float64)
    return color, wp.types.vector(length=model.area_count, dtype=wp.float64)


@cache
def _normal_equations(model: ColorModel) -> Any:
    """Functions that centre the sums on a triangle and factorise the normal equations."""
    terms = model.term_count
    exponents = model.exponents
    color_type, area_type = _float_types(model)
    product = tuple(
        tuple(model.area_moment(a[0] + b[0], a[1] + b[1]) for b in exponents) for a in exponents
    )
    matrix_type = wp.types.matrix(shape=(terms, terms), dtype=wp.float64)
    area_shifts = _shifts(model.area_exponents)
    color_shifts = _shifts(exponents)

    @wp.func
    def centre_area(sums: area_type, x: wp.float64, y: wp.float64) -> area_type:
        """Area moments with x and y counted from another origin; exact."""
        moved = area_type()
        for n in range(wp.static(len(area_shifts))):
            factor = wp.float64(wp.static(float(area_shifts[n][2])))
            for _a in range(wp.static(area_shifts[n][3])):
                factor *= -x
            for _b in range(wp.static(area_shifts[n][4])):
                factor *= -y
            moved[wp.static(area_shifts[n][0])] += factor * sums[wp.static(area_shifts[n][1])]
        return moved

    @wp.func
    def centre_color(sums: color_type, x: wp.float64, y: wp.float64) -> color_type:
        """Colour moments with x and y counted from another origin; exact."""
        moved = color_type()
        for n in range(wp.static(len(color_shifts))):
            factor = wp.float64(wp.static(float(color_shifts[n][2])))
            for _a in range(wp.static(color_shifts[n][3])):
                factor *= -x
            for _b in range(wp.static(color_shifts[n][4])):
                factor *= -y
            for channel in range(3):
                moved[4 * wp.static(color_shifts[n][0]) + channel] += (
                    factor * sums[4 * wp.static(color_shifts[n][1]) + channel]
                )
        moved[wp.static(SQUARE)] = sums[wp.static(SQUARE)]
        return moved

    @wp.func
    def factorise(area: area_type) -> matrix_type:
        """Lower Cholesky factor; all zero but its first entry where the matrix is singular."""
        lower = matrix_type()
        zero = wp.float64(0.0)
        regular = wp.float64(1.0)
        for j in range(wp.static(terms)):
            diagonal = area[wp.static(product[j][j])]
            pivot = diagonal
            for k in range(j):
                pivot -= lower[j, k] * lower[j, k]
            regular = wp.where(pivot > wp.float64(wp.static(SINGULAR)) * diagonal, regular, zero)
            root = wp.sqrt(wp.max(pivot, zero))
            divisor = wp.where(root > zero, root, wp.float64(1.0))
            lower[j, j] = root
            for i in range(wp.static(terms)):
                if wp.static(i > j):
                    below = area[wp.static(product[j][i])]
                    for k in range(j):
                        below -= lower[i, k] * lower[j, k]
                    lower[i, j] = below / divisor
        for i in range(wp.static(terms)):
            for j in range(wp.static(terms)):
                if wp.static(i >= j and i > 0):
                    lower[i, j] = wp.where(regular > zero, lower[i, j], zero)
        return lower

    return centre_area, centre_color, factorise, matrix_type


def _shifts(exponents: tuple[tuple[int, int], ...]) -> tuple[tuple[int, int, int, int, int], ...]:
    """Binomial expansion of (x - u)^a (y - v)^b over all terms.

    Returns:
        Rows of target term, source term, binomial coefficient, power of -u, power of -v.
    """
    return tuple(
        (target, exponents.index((i, j)), comb(a, i) * comb(b, j), a - i, b - j)
        for target, (a, b) in enumerate(exponents)
        for i in range(a + 1)
        for j in range(b + 1)
    )


@cache
def fit_moments(model: ColorModel) -> Any:
    """A wp.func: from one triangle's moments to a `Fit`, after forward substitution.

    Without a branch, so that a processor can solve several variants at once. Sums stay below
    2^53 (see `check_size`): as float64 they and their shifts to another origin are exact.
    """
    color_type, area_type = moment_types(model).color, moment_types(model).area
    float_color_type, float_area_type = _float_types(model)
    terms = model.term_count
    centre_area, centre_color, factorise, matrix_type = _normal_equations(model)
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
def _edge_energy_kernel(model: ColorModel) -> Any:
    types = moment_types(model)
    color_type, area_type = types.color, types.area
    side_color, side_area = _side_sums(model)
    fit = fit_moments(model)

    energies_type = wp.types.vector(length=TRIANGLE_VARIANTS, dtype=wp.float64)

    @wp.kernel(enable_backward=False, module="unique")
    def solve_variants(
        span: wp.array(dtype=wp.vec2i),
        # In:
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array2d(dtype=color_type),
        area_sums: wp.array2d(dtype=area_type),
        # Out:
        energies_out: wp.array2d(dtype=wp.float64),
    ):
        """Solve the variants of one triangle, in a loop that LLVM runs four at a time."""
        triangle = span[0][0] + wp.tid()
        if triangle >= span[0][1]:
            return
        side = sides[triangle]
        energies = energies_type()
        variant = int(0)
        while variant < wp.static(TRIANGLE_VARIANTS):
            color = color_type()
            area = area_type()
            for n in range(3):
                version = edge_version(variant, n, side[n] & 1)
                color += side_color(color_sums, side[n], version)
                area += side_area(area_sums, side[n], version)
            energies[variant] = fit(color, area).energy
            variant += 1
        for n in range(wp.static(TRIANGLE_VARIANTS)):
            energies_out[triangle, n] = energies[n]

    return solve_variants


@cache
def _fragment_energy_kernel(model: ColorModel) -> Any:
    color_type, area_type = moment_types(model).color, moment_types(model).area
    fit = fit_moments(model)

    @wp.kernel(enable_backward=False, module="unique")
    def solve_variants(
        span: wp.array(dtype=wp.vec2i),
        # In:
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array2d(dtype=color_type),
        area_sums: wp.array2d(dtype=area_type),
        # Out:
        energies_out: wp.array2d(dtype=wp.float64),
    ):
        """Solve one variant of one triangle."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        triangle = number / wp.static(TRIANGLE_VARIANTS)
        variant = number - triangle * wp.static(TRIANGLE_VARIANTS)
        best = fit(color_sums[triangle, variant], area_sums[triangle, variant])
        energies_out[triangle, variant] = best.energy

    return solve_variants


@cache
def _fit_kernel(model: ColorModel) -> Any:
    types = moment_types(model)
    color_type, area_type = types.color, types.area
    terms = model.term_count
    side_color, side_area = _side_sums(model)
    fit = fit_moments(model)
    shifts = _shifts(model.exponents)

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
            for n in range(wp.static(len(shifts))):
                factor = wp.float64(wp.static(float(shifts[n][2])))
                for _a in range(wp.static(shifts[n][3])):
                    factor *= -x
                for _b in range(wp.static(shifts[n][4])):
                    factor *= -y
                coefficients_out[triangle, channel, wp.static(shifts[n][1])] += (
                    factor * best.half[wp.static(shifts[n][0]), channel]
                )

    return fit_colors


def record_energies(
    device: Device,
    model: ColorModel,
    sums: str,
    *,
    sides: wp.array,
    color_sums: wp.array,
    area_sums: wp.array,
    energies_out: wp.array,
) -> Phase:
    """Prepare the launch that finds E of all thirteen variants of every triangle.

    Args:
        device: Where to run.
        model: The polynomial colour.
        sums: "edges" or "fragments", the way in which the moments were summed.
        sides: For each side c of a triangle 2 * edge + (1 where the edge runs the other way),
            [T] vec3i. Not read with "fragments".
        color_sums: [E, 9] with "edges", [T, 13] with "fragments".
        area_sums: As `color_sums`.
        energies_out: E(T) [code value^2 px], [T, 13].

    Source: Lawonn & Guenther (2018), Eqs. 4, 13-15 (without the 1 / q of Eq. 13, so that energies
        add up, as Eq. 12 needs).
    """
    inputs = [sides, color_sums, area_sums]
    if sums == "edges":
        kernel = _edge_energy_kernel(model)
        return device.record(kernel, inputs, [energies_out], smallest_part=SMALLEST_PART)
    kernel = _fragment_energy_kernel(model)
    return device.record(kernel, inputs, [energies_out], per_element=TRIANGLE_VARIANTS)


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
