"""A walk down the rows of one triangle's pixels, between its long edge and the two short ones."""

import warp as wp

from warp_kernels.raster import EdgeWalk, column_of, to_fixed, walk_edge

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.struct
class TriangleWalk:
    """Where a walk down a triangle stands: `row` goes from `begin` to before `end`."""

    row: int
    """The row it stands in [px]."""
    end: int
    """One past the last row [px]."""
    whole: EdgeWalk
    """The edge from the top to the bottom."""
    half: EdgeWalk
    """The edge beside it in this row."""
    middle: wp.vec2i
    """Where the first short edge ends [1/256 px]."""
    bottom: wp.vec2i
    """Where the second one ends [1/256 px]."""


@wp.func
def walk_triangle(a: wp.vec2d, b: wp.vec2d, c: wp.vec2d, height: int) -> TriangleWalk:
    """Start above the first row; `step_down` comes to it.

    Args:
        a: A corner [px].
        b: Another one [px].
        c: The third [px].
        height: Rows of the image [px].
    """
    top = to_fixed(a)
    middle = to_fixed(b)
    bottom = to_fixed(c)
    if middle[1] < top[1]:
        swap = top
        top = middle
        middle = swap
    if bottom[1] < top[1]:
        swap = top
        top = bottom
        bottom = swap
    if bottom[1] < middle[1]:
        swap = middle
        middle = bottom
        bottom = swap
    walk = TriangleWalk()
    walk.middle = middle
    walk.bottom = bottom
    walk.whole = walk_edge(top, bottom, height)
    walk.half = walk_edge(top, middle, height)
    walk.row = walk.whole.row_begin - 1
    walk.end = walk.whole.row_end
    return walk


@wp.func
def step_down(walk: TriangleWalk, height: int) -> TriangleWalk:
    """Go on to the next row."""
    if walk.row >= walk.whole.row_begin:
        walk.whole.position += walk.whole.step
        walk.half.position += walk.half.step
    walk.row += 1
    if walk.row == walk.half.row_end:
        walk.half = walk_edge(walk.middle, walk.bottom, height)
    return walk


@wp.func
def columns_of(walk: TriangleWalk, width: int) -> wp.vec2i:
    """The first of the row's columns, and one past the last."""
    one = column_of(walk.whole.position)
    other = column_of(walk.half.position)
    return wp.vec2i(wp.max(wp.min(one, other), 0), wp.min(wp.max(one, other), width))
