"""The only definition of "this pixel lies left of that edge", in fixed point.

Vertices are rounded to 1/256 px for coverage only. An edge is walked from its upper to its lower
end whichever triangle asks, so both neighbours see the same columns; a row belongs to an edge
when the row's centre lies in the half-open interval of its ends. With these two rules every pixel
of the image lies in exactly one triangle of a mesh, and every sum over pixels is an integer that
depends on nothing but the mesh.
"""

import warp as wp

from warp_kernels.limits import MAX_SIDE

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

SUBPIXELS = 256
"""Fixed-point units per pixel."""
HALF = 128

_UNIT = wp.constant(SUBPIXELS)
_HALF = wp.constant(HALF)
_INVERSE_UNIT = wp.constant(1.0 / SUBPIXELS)

FRACTION_BITS = 46
"""Of a walk's position, see `EdgeWalk`."""
_FRACTION_BITS = wp.constant(wp.int64(FRACTION_BITS))
_POSITION_UNIT = wp.constant(2.0**FRACTION_BITS)
_FARTHEST = wp.constant(2.0 * MAX_SIDE)


@wp.struct
class EdgeWalk:
    """An integer walk down one edge, a row at a time: `position` grows by `step` with each.

    `column_of` a position is the number of pixel centres of its row that lie left of the edge.
    """

    row_begin: int
    """First row whose centre lies between the ends [px]."""
    row_end: int
    """One past the last such row [px]; no less than `row_begin`."""
    position: wp.int64
    """Where the edge stands in its first row [2^-46 px], see `walk_edge`."""
    step: wp.int64
    """Change per row [2^-46 px]."""
    sign: int
    """+1 where the edge was given downwards, -1 where upwards."""


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
    """Start the walk down the edge a-b at its first row inside the image; without a branch.

    A row's column is the number of pixels for which `winding` is not zero there, which is
    ceil(x - 1/2) = floor(n / d) with integers n and d = 256 rise < 2^30. The walk keeps
    (n + 1/2) / d instead. That is at least 2^-31 away from every whole number, so its whole part
    is exact although its fraction is rounded: the start is off by less than 2^-37, the steps by
    less than 2^-39 for all rows together (they cross the image once) and by 2^-46 for each of
    2^13 rows. Thus a row costs one addition and one shift, and no remainder is carried along.

    Args:
        a: One end, at most a pixel outside the image to the left and right [1/256 px].
        b: The other end [1/256 px].
        height: Rows of the image [px]; rows outside are left out.
    """
    walk = EdgeWalk()
    upwards = b[1] < a[1]
    top = wp.where(upwards, b, a)
    bottom = wp.where(upwards, a, b)
    walk.sign = wp.where(upwards, -1, 1)
    walk.row_begin = wp.max(first_row_below(top[1]), 0)
    walk.row_end = wp.max(wp.min(first_row_below(bottom[1]), height), walk.row_begin)
    rise = wp.max(bottom[1] - top[1], 1)
    run = bottom[0] - top[0]
    # n / d = x - 1/2 rounded up, where x = top.x + (row centre - top.y) run / rise
    below = walk.row_begin * _UNIT + _HALF - top[1]
    numerator = (
        wp.int64(top[0] - _HALF) * wp.int64(rise)
        + wp.int64(below) * wp.int64(run)
        + wp.int64(rise * _UNIT - 1)
    )
    inverse = wp.float64(1.0) / wp.float64(rise)
    middle = (wp.float64(numerator) + wp.float64(0.5)) * inverse
    walk.position = to_position(middle * wp.float64(_INVERSE_UNIT))
    walk.step = to_position(wp.float64(run) * inverse)
    return walk


@wp.func
def to_position(columns: wp.float64) -> wp.int64:
    """Fixed point of a number of columns [2^-46 px].

    Only an edge that crosses no row centre, or a step that is never taken, can lie far outside
    the image; it is limited so that no sum of a few steps leaves int64.
    """
    limit = wp.float64(_FARTHEST)
    return wp.int64(wp.clamp(columns, -limit, limit) * wp.float64(_POSITION_UNIT))


@wp.func
def column_of(position: wp.int64) -> int:
    """Pixels of the row that lie left of a walk's position, not yet limited to the image."""
    return int(position >> _FRACTION_BITS)
