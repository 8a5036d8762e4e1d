"""Numbering of the displaced versions of a triangle and of an edge.

A triangle has 1 + 12 variants (Eq. 11): variant 0 is the triangle itself, variant 1 + 4 c + d has
corner c moved by one finite-difference step in direction d (+x, -x, +y, -y). An edge has 1 + 8
versions by the same rule, with its two ends for c: moving a corner changes two edges only, and
both triangles beside an edge read the same nine sums.
"""

import warp as wp

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

DIRECTIONS = 4
TRIANGLE_VARIANTS = 1 + 3 * DIRECTIONS
EDGE_VERSIONS = 1 + 2 * DIRECTIONS


@wp.func
def displacement(direction: int, delta: int) -> wp.vec2i:
    """The step of a direction: +x, -x, +y, -y by delta [1/256 px]."""
    sign = 1 - 2 * (direction & 1)
    if direction < 2:
        return wp.vec2i(sign * delta, 0)
    return wp.vec2i(0, sign * delta)


@wp.func
def end_displacement(version: int, end: int, delta: int) -> wp.vec2i:
    """How far an end, 0 or 1, of an edge is displaced in a version [1/256 px]; without a branch."""
    direction = version - 1 - wp.static(DIRECTIONS) * end
    size = wp.where(wp.uint32(direction) < wp.uint32(wp.static(DIRECTIONS)), delta, 0)
    size *= 1 - 2 * (direction & 1)
    vertical = (direction >> 1) & 1
    return wp.vec2i(size * (1 - vertical), size * vertical)


@wp.func
def first_version(end: int, reversed_edge: int) -> int:
    """The first of the versions in which one end of a triangle's side moves, 0 or 1.

    `reversed_edge` is 1 where the stored edge runs the other way than the side.
    """
    return 1 + wp.static(DIRECTIONS) * (end ^ reversed_edge)
