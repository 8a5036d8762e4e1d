"""The only definition of "this pixel lies left of that edge", in fixed point.

Vertices are rounded to 1/256 px for coverage only. An edge is walked from its upper to its lower
end whichever triangle asks, so both neighbours see the same columns; a row belongs to an edge
when the row's centre lies in the half-open interval of its ends. With these two rules every pixel
of the image lies in exactly one triangle of a mesh, and every sum over pixels is an integer that
depends on nothing but the mesh.
"""

import warp as wp

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

SUBPIXELS = 256
"""Fixed-point units per pixel."""
HALF = 128
MAX_SIDE = 8192
"""Largest width or height [px]: keeps an edge's remainder below 2^30 and prefix sums in int32."""

_UNIT = wp.constant(SUBPIXELS)
_HALF = wp.constant(HALF)
_INVERSE_UNIT = wp.constant(1.0 / SUBPIXELS)


@wp.struct
class EdgeWalk:
    """State of an integer walk down one edge, a row at a time."""

    row_begin: int
    """First row whose centre lies between the ends [px]."""
    row_end: int
    """One past the last such row [px]."""
    column: int
    """Number of pixel centres of the current row that lie left of the edge, not yet clamped."""
    remainder: int
    """Numerator of what `column` was rounded up by, below `denominator`."""
    column_step: int
    """Whole columns per row."""
    remainder_step: int
    """Rest of the columns per row, in units of 1 / `denominator`."""
    denominator: int
    """256 times the edge's height in fixed-point units."""
    sign: int
    """+1 where the edge was given downwards, -1 where upwards, 0 where it crosses no row centre."""


@wp.func
def to_fixed(point: wp.vec2d) -> wp.vec2i:
    """Round a position [px] to fixed point [1/256 px]."""
    return wp.vec2i(
        int(wp.floor(point[0] * wp.float64(_UNIT) + wp.float64(0.5))),
        int(wp.floor(point[1] * wp.float64(_UNIT) + wp.float64(0.5))),
    )


@wp.func
def first_row_below(y: int) -> int:
    """The first row whose centre is at or below the fixed-point height y [1/256 px]."""
    return (y + _HALF - 1) >> 8


@wp.func
def winding(a: wp.vec2i, b: wp.vec2i, column: int, row: int) -> int:
    """What the edge from a to b adds to the winding number of a pixel: the definition.

    +1 where the pixel's centre lies strictly left of an edge that runs down through its row, -1
    where the edge runs up, 0 elsewhere. Summed over a triangle's three edges it is 1 inside, 0
    outside, and -1 inside a triangle that is turned inside out.

    Args:
        a: Where the edge starts [1/256 px].
        b: Where it ends [1/256 px].
        column: The pixel's column [px].
        row: The pixel's row [px].
    """
    x = column * _UNIT + _HALF
    y = row * _UNIT + _HALF
    top = a
    bottom = b
    sign = int(1)
    if b[1] < a[1]:
        top = b
        bottom = a
        sign = -1
    if y < top[1] or y >= bottom[1]:
        return 0
    to_pixel = wp.int64(x - top[0]) * wp.int64(bottom[1] - top[1])
    to_edge = wp.int64(y - top[1]) * wp.int64(bottom[0] - top[0])
    if to_pixel < to_edge:
        return sign
    return 0


@wp.func
def walk_edge(a: wp.vec2i, b: wp.vec2i, height: int) -> EdgeWalk:
    """Start the walk down the edge a-b at its first row inside the image.

    `column` of a row is the number of pixels for which `winding` is not zero there.

    Args:
        a: One end [1/256 px].
        b: The other end [1/256 px].
        height: Rows of the image [px]; rows outside are left out.
    """
    walk = EdgeWalk()
    top = a
    bottom = b
    walk.sign = 1
    if b[1] < a[1]:
        top = b
        bottom = a
        walk.sign = -1
    walk.row_begin = wp.max(first_row_below(top[1]), 0)
    walk.row_end = wp.min(first_row_below(bottom[1]), height)
    if walk.row_end <= walk.row_begin:
        walk.sign = 0
        walk.row_end = walk.row_begin
        return walk
    rise = bottom[1] - top[1]
    run = bottom[0] - top[0]
    walk.denominator = rise * _UNIT
    # column = ceil(x - 1/2) with x = top.x + (row centre - top.y) * run / rise, all in integers
    below = walk.row_begin * _UNIT + _HALF - top[1]
    numerator = (
        wp.int64(top[0] - _HALF) * wp.int64(rise)
        + wp.int64(below) * wp.int64(run)
        + wp.int64(walk.denominator - 1)
    )
    inverse = wp.float64(1.0) / wp.float64(rise)
    walk.column_step = floor_quotient(wp.int64(run), rise, inverse)
    walk.remainder_step = (run - walk.column_step * rise) * _UNIT
    inverse = inverse * wp.float64(_INVERSE_UNIT)
    walk.column = floor_quotient(numerator, walk.denominator, inverse)
    walk.remainder = int(numerator - wp.int64(walk.column) * wp.int64(walk.denominator))
    return walk


@wp.func
def carry_of(remainder: int, denominator: int) -> int:
    """1 where the remainder has reached the denominator, else 0; without a branch."""
    return 1 + ((remainder - denominator) >> 31)


@wp.func
def floor_quotient(numerator: wp.int64, denominator: int, inverse: wp.float64) -> int:
    """Exact quotient rounded down, from a float64 guess that is at most one off.

    A 64-bit integer division costs more than walking a short edge; a multiplication by the
    inverse, put right by looking at the remainder, is exact and several times cheaper.

    Args:
        numerator: Below 2^53 in absolute value.
        denominator: Positive, below 2^30.
        inverse: 1 / denominator in float64.
    """
    quotient = int(wp.floor(wp.float64(numerator) * inverse))
    remainder = int(numerator - wp.int64(quotient) * wp.int64(denominator))
    return quotient + (remainder >> 31) + carry_of(remainder, denominator)
