"""The normal equations of one triangle: sums seen from its own middle, and their factorisation.

The equations of Eq. 15 share one matrix between the channels: one Cholesky factor serves all.
"""

from functools import cache
from math import comb
from typing import Any

import warp as wp

from warp_kernels.color_model import SQUARE, ColorModel

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

SINGULAR = 1e-9
"""A pivot this small beside its diagonal entry makes the matrix singular: the constant is used."""


@cache
def float_types(model: ColorModel) -> tuple[Any, Any]:
    """The vector types of colour and area moments in float64."""
    color = wp.types.vector(length=4 * model.term_count, dtype=wp.float64)
    return color, wp.types.vector(length=model.area_count, dtype=wp.float64)


@cache
def centring(model: ColorModel) -> tuple[Any, Any]:
    """Two wp.funcs: area and colour moments with x and y counted from another origin."""
    color_type, area_type = float_types(model)
    area_shifts = shifts(model.area_exponents)
    color_shifts = shifts(model.exponents)

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

    return centre_area, centre_color


@cache
def factorising(model: ColorModel) -> tuple[Any, Any]:
    """A wp.func: the Cholesky factor of the normal equations, and the type of its matrix."""
    terms = model.term_count
    exponents = model.exponents
    _, area_type = float_types(model)
    product = tuple(
        tuple(model.area_moment(a[0] + b[0], a[1] + b[1]) for b in exponents) for a in exponents
    )
    matrix_type = wp.types.matrix(shape=(terms, terms), dtype=wp.float64)

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

    return factorise, matrix_type


def shifts(exponents: tuple[tuple[int, int], ...]) -> tuple[tuple[int, int, int, int, int], ...]:
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
