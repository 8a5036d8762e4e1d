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

SUMS = ("edges", "fragments")
"""The two ways to sum, see `edge_moments` and `fragments`."""


@cache
def _gather(model: ColorModel, sums: str) -> tuple[Any, Any]:
    """Two wp.funcs: colour and area moments of one variant of one triangle.

    With `edges` they add the three sides' sums; with `fragments` they read the sums as they are.
    """
    types = moment_types(model)
    color_type, area_type = types.color, types.area

    @wp.func
    def color_from_edges(
        triangle: int,
        variant: int,
        sides: wp.array(dtype=wp.vec3i),
        sums: wp.array2d(dtype=color_type),
    ) -> color_type:
        total = color_type()
        for side in range(3):
            code = sides[triangle][side]
            sign = wp.int64(1 - 2 * (code & 1))
            total += sign * sums[code >> 1, edge_version(variant, side, code & 1)]
        return total

    @wp.func
    def area_from_edges(
        triangle: int,
        variant: int,
        sides: wp.array(dtype=wp.vec3i),
        sums: wp.array2d(dtype=area_type),
    ) -> area_type:
        total = area_type()
        for side in range(3):
            code = sides[triangle][side]
            sign = wp.int64(1 - 2 * (code & 1))
            total += sign * sums[code >> 1, edge_version(variant, side, code & 1)]
        return total

    @wp.func
    def color_as_is(
        triangle: int,
        variant: int,
        sides: wp.array(dtype=wp.vec3i),
        sums: wp.array2d(dtype=color_type),
    ) -> color_type:
        return sums[triangle, variant]

    @wp.func
    def area_as_is(
        triangle: int,
        variant: int,
        sides: wp.array(dtype=wp.vec3i),
        sums: wp.array2d(dtype=area_type),
    ) -> area_type:
        return sums[triangle, variant]

    if sums == "edges":
        return color_from_edges, area_from_edges
    return color_as_is, area_as_is


@cache
def _normal_equations(model: ColorModel) -> Any:
    """Functions that centre the sums on a triangle and factorise the normal equations."""
    types = moment_types(model)
    color_type, area_type = types.color, types.area
    terms = model.term_count
    exponents = model.exponents
    product = tuple(
        tuple(model.area_moment(a[0] + b[0], a[1] + b[1]) for b in exponents) for a in exponents
    )
    matrix_type = wp.types.matrix(shape=(terms, terms), dtype=wp.float64)
    area_shifts = _shifts(model.area_exponents)
    color_shifts = _shifts(exponents)

    @wp.func
    def centre_area(sums: area_type, x: wp.int64, y: wp.int64) -> area_type:
        """Area moments with x and y counted from another origin; exact."""
        moved = area_type()
        for n in range(wp.static(len(area_shifts))):
            factor = wp.int64(wp.static(area_shifts[n][2]))
            for _a in range(wp.static(area_shifts[n][3])):
                factor *= -x
            for _b in range(wp.static(area_shifts[n][4])):
                factor *= -y
            moved[wp.static(area_shifts[n][0])] += factor * sums[wp.static(area_shifts[n][1])]
        return moved

    @wp.func
    def centre_color(sums: color_type, x: wp.int64, y: wp.int64) -> color_type:
        """Colour moments with x and y counted from another origin; exact."""
        moved = color_type()
        for n in range(wp.static(len(color_shifts))):
            factor = wp.int64(wp.static(color_shifts[n][2]))
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
        regular = wp.float64(1.0)
        for j in range(wp.static(terms)):
            diagonal = wp.float64(area[wp.static(product[j][j])])
            pivot = diagonal
            for k in range(j):
                pivot -= lower[j, k] * lower[j, k]
            if pivot <= wp.float64(wp.static(SINGULAR)) * diagonal:
                regular = wp.float64(0.0)
            root = wp.sqrt(wp.max(pivot, wp.float64(0.0)))
            lower[j, j] = regular * root
            for i in range(wp.static(terms)):
                if i > j and regular > wp.float64(0.0):
                    below = wp.float64(area[wp.static(product[j][i])])
                    for k in range(j):
                        below -= lower[i, k] * lower[j, k]
                    lower[i, j] = below / root
        if regular == wp.float64(0.0):
            constant = lower[0, 0]
            lower = matrix_type()
            lower[0, 0] = constant
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
    """A wp.func: from one triangle's moments to a `Fit`, after forward substitution."""
    types = moment_types(model)
    color_type, area_type = types.color, types.area
    terms = model.term_count
    centre_area, centre_color, factorise, matrix_type = _normal_equations(model)
    half_type = wp.types.matrix(shape=(terms, 3), dtype=wp.float64)

    @wp.struct
    class Fit:
        """The least-squares colour of one triangle, after forward substitution."""

        count: wp.int64
        x: wp.int64
        y: wp.int64
        energy: wp.float64
        lower: matrix_type
        half: half_type

    @wp.func
    def fit(color_sums: color_type, area_sums: area_type) -> Fit:
        """Factorise the normal equations and substitute forward."""
        result = Fit()
        color = color_sums
        area = area_sums
        if area[0] < wp.int64(0):  # turned inside out: the error of what it covers all the same
            area = -area
            color = -color
        result.count = area[0]
        if area[0] > wp.int64(0):
            if wp.static(terms > 1):
                result.x = area[1] / area[0]
                result.y = area[2] / area[0]
                area = centre_area(area, result.x, result.y)
                color = centre_color(color, result.x, result.y)
            result.lower = factorise(area)
            explained = wp.float64(0.0)
            for i in range(wp.static(terms)):
                pivot = result.lower[i, i]
                if pivot > wp.float64(0.0):
                    for channel in range(3):
                        value = wp.float64(color[4 * i + channel])
                        for k in range(i):
                            value -= result.lower[i, k] * result.half[k, channel]
                        value = value / pivot
                        result.half[i, channel] = value
                        explained += value * value
            square = wp.float64(color[wp.static(SQUARE)])
            result.energy = wp.float64(0.5) * wp.max(square - explained, wp.float64(0.0))
        return result

    return fit


@cache
def _energy_kernel(model: ColorModel, sums: str) -> Any:
    types = moment_types(model)
    color_type, area_type = types.color, types.area
    color_of, area_of = _gather(model, sums)
    fit = fit_moments(model)

    @wp.kernel(enable_backward=False, module="unique")
    def solve_variants(
        begin: int,
        # In:
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array2d(dtype=color_type),
        area_sums: wp.array2d(dtype=area_type),
        # Out:
        energies_out: wp.array2d(dtype=wp.float64),
    ):
        number = begin + wp.tid()
        triangle = number / wp.static(TRIANGLE_VARIANTS)
        variant = number - triangle * wp.static(TRIANGLE_VARIANTS)
        color = color_of(triangle, variant, sides, color_sums)
        area = area_of(triangle, variant, sides, area_sums)
        energies_out[triangle, variant] = fit(color, area).energy

    return solve_variants


@cache
def _fit_kernel(model: ColorModel) -> Any:
    types = moment_types(model)
    color_type, area_type = types.color, types.area
    terms = model.term_count
    color_of, area_of = _gather(model, "edges")
    fit = fit_moments(model)
    shifts = _shifts(model.exponents)

    @wp.kernel(enable_backward=False, module="unique")
    def fit_colors(
        begin: int,
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
        triangle = begin + wp.tid()
        color = color_of(triangle, 0, sides, color_sums)
        best = fit(color, area_of(triangle, 0, sides, area_sums))
        energies_out[triangle] = best.energy
        counts_out[triangle] = best.count
        # from pixel numbers counted from the triangle's own middle to positions in the image
        x = wp.float64(best.x + wp.int64(width / 2)) + wp.float64(0.5)
        y = wp.float64(best.y + wp.int64(height / 2)) + wp.float64(0.5)
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
    kernel = _energy_kernel(model, sums)
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
