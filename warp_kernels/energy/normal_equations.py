"""The normal equations of one triangle: sums seen from its own middle, and their factorisation.

The equations of Eq. 15 share one matrix A between the channels: one factor serves all. It is that
of A = L D L', Cholesky's without its roots: a processor takes as long for one as for twenty sums.
"""

from functools import cache
from math import comb
from typing import Any

import warp as wp

from warp_kernels.color_model import CHANNELS, ColorModel
from warp_kernels.moments.moment_layout import MomentLayout, moment_types

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

SINGULAR = 1e-9
"""A pivot this small beside its diagonal entry makes the matrix singular: a lower degree is
used."""


@cache
def float_types(model: ColorModel) -> tuple[Any, Any]:
    """The vector types of colour and area moments in float64."""
    color = wp.types.vector(length=4 * model.term_count, dtype=wp.float64)
    return color, wp.types.vector(length=model.area_count, dtype=wp.float64)


@cache
def centring(layout: MomentLayout) -> tuple[Any, Any]:
    """Two wp.funcs: area and colour moments with x and y counted from another origin, in float64.

    Both are exact. Narrow sums and their moves stay below 2^53; wide ones are moved as integers,
    since they wrap around until they are seen from the triangle's own middle.
    """
    types, model = moment_types(layout), layout.model
    color_type, area_type, integer = types.color, types.area, types.integer
    float_color_type, float_area_type = float_types(model)
    scalar = integer if layout.wide else wp.float64
    moved_color_type = color_type if layout.wide else float_color_type
    moved_area_type = area_type if layout.wide else float_area_type
    move_color = _mover(model.exponents, moved_color_type, scalar, 4)
    move_area = _mover(model.area_exponents, moved_area_type, scalar, 1)
    signed = wp.int64

    @wp.func
    def wide_area(
        sums: area_type, sign: wp.float64, x: wp.float64, y: wp.float64
    ) -> float_area_type:
        """Move as integers, then convert."""
        moved = move_area(sums, integer(signed(x)), integer(signed(y)))
        area = float_area_type()
        for n in range(wp.static(model.area_count)):
            area[n] = sign * wp.float64(signed(moved[n]))
        return area

    @wp.func
    def wide_color(
        sums: color_type, sign: wp.float64, x: wp.float64, y: wp.float64
    ) -> float_color_type:
        """Move as integers, then convert."""
        moved = move_color(sums, integer(signed(x)), integer(signed(y)))
        color = float_color_type()
        for term in range(wp.static(model.term_count)):
            for channel in range(4):
                color[4 * term + channel] = sign * wp.float64(signed(moved[4 * term + channel]))
        return color

    @wp.func
    def narrow_area(
        sums: area_type, sign: wp.float64, x: wp.float64, y: wp.float64
    ) -> float_area_type:
        """Convert, then move."""
        area = float_area_type()
        for n in range(wp.static(model.area_count)):
            area[n] = sign * wp.float64(sums[n])
        return move_area(area, x, y)

    @wp.func
    def narrow_color(
        sums: color_type, sign: wp.float64, x: wp.float64, y: wp.float64
    ) -> float_color_type:
        """Convert, then move."""
        color = float_color_type()
        for term in range(wp.static(model.term_count)):
            for channel in range(4):
                color[4 * term + channel] = sign * wp.float64(sums[4 * term + channel])
        return move_color(color, x, y)

    return (wide_area, wide_color) if layout.wide else (narrow_area, narrow_color)


@cache
def _mover(exponents: tuple[tuple[int, int], ...], sums: Any, scalar: Any, stride: int) -> Any:
    """A wp.func: count x and y of the sums of x^a y^b from another origin.

    Each pass replaces one more factor x by x - u: S(a, b) becomes S(a, b) - u S(a - 1, b).

    Args:
        exponents: Powers of the terms.
        sums: Vector type of the sums.
        scalar: Type of one of them.
        stride: 1 for one sum per term, 4 for those of the channels and one that stays.
    """
    passes = (_passes(exponents, 0), _passes(exponents, 1))
    channels = min(stride, CHANNELS)

    @wp.func
    def move(sums: sums, x: scalar, y: scalar) -> sums:
        """Pass after pass, along x and then along y."""
        moved = sums
        for axis in range(2):
            away = x
            if wp.static(axis == 1):
                away = y
            for number in range(wp.static(len(passes[axis]))):
                for n in range(wp.static(len(passes[axis][number]))):
                    for channel in range(wp.static(channels)):
                        moved[wp.static(stride * passes[axis][number][n][0]) + channel] -= (
                            away * moved[wp.static(stride * passes[axis][number][n][1]) + channel]
                        )
        return moved

    return move


def _passes(
    exponents: tuple[tuple[int, int], ...], axis: int
) -> tuple[tuple[tuple[int, int], ...], ...]:
    """Passes that move the origin along an axis: in each the terms and those of one power less.

    A higher power comes first, for it needs the lower one as it was before the pass.
    """
    lower = [(a - (axis == 0), b - (axis == 1)) for a, b in exponents]
    return tuple(
        tuple(
            (term, exponents.index(lower[term]))
            for term in reversed(range(len(exponents)))
            if exponents[term][axis] >= least
        )
        for least in range(1, 1 + max(powers[axis] for powers in exponents))
    )


@cache
def factorising(model: ColorModel) -> tuple[Any, Any]:
    """A wp.func: the factor of the normal equations, and the type of its matrix.

    Terms are ordered by degree, so the factor of a lower degree is a part of that of a higher one:
    where a matrix is singular, the largest regular part of it remains.
    """
    terms = model.term_count
    exponents = model.exponents
    _, area_type = float_types(model)
    product = tuple(
        tuple(model.area_moment(a[0] + b[0], a[1] + b[1]) for b in exponents) for a in exponents
    )
    degrees = tuple(a + b for a, b in exponents)
    matrix_type = wp.types.matrix(shape=(terms, terms), dtype=wp.float64)
    regular_type = wp.types.vector(length=model.degree + 1, dtype=wp.float64)

    @wp.func
    def factorise(area: area_type, trusted: wp.float64) -> matrix_type:
        """L D below the diagonal, and on it the inverse of D.

        The inverse is 0 from the first degree on that makes the matrix singular, which takes these
        terms out of all that follows. `trusted` is 0 where the moments of powers above 2 cannot
        be read.
        """
        lower = matrix_type()
        zero = wp.float64(0.0)
        one = wp.float64(1.0)
        regular = regular_type(one)
        for j in range(wp.static(terms)):
            diagonal = area[wp.static(product[j][j])]
            pivot = diagonal
            for k in range(j):
                pivot -= lower[j, k] * lower[j, k] * lower[k, k]
            firm = pivot > wp.float64(wp.static(SINGULAR)) * diagonal
            for degree in range(wp.static(model.degree + 1)):
                if wp.static(degree >= degrees[j]):
                    regular[degree] = wp.where(firm, regular[degree], zero)
            lower[j, j] = wp.where(firm, one / wp.where(firm, pivot, one), zero)
            for i in range(wp.static(terms)):
                if wp.static(i > j):
                    below = area[wp.static(product[j][i])]
                    for k in range(j):
                        below -= lower[i, k] * lower[j, k] * lower[k, k]
                    lower[i, j] = below
        for i in range(wp.static(terms)):
            kept = regular[wp.static(degrees[i])]
            if wp.static(degrees[i] > 1):
                kept *= trusted
            lower[i, i] *= kept
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
