"""Coordinates that belong to a triangle, for shaders: they move, turn and fade with it."""

import warp as wp

from warp_kernels.scene import Sample, Scene

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def perpendicular(v: wp.vec2f) -> wp.vec2f:
    """A vector turned by a quarter: from the base edge to the inside of its triangle."""
    return wp.vec2f(-v[1], v[0])


@wp.func
def base_direction(scene: Scene, triangle: int) -> wp.vec2f:
    """Unit vector along the base edge."""
    base = scene.sides[triangle, 0]
    return base / wp.max(wp.length(base), 1.0e-6)


@wp.func
def along_base(scene: Scene, sample: Sample) -> wp.vec2f:
    """Position along the base edge and from it to the inside, counted from corner 0 [px]."""
    base = base_direction(scene, sample.triangle)
    return wp.vec2f(wp.dot(base, sample.offset), wp.dot(perpendicular(base), sample.offset))


@wp.func
def depth_from(a: wp.vec2f, b: wp.vec2f, p: wp.vec2f) -> float:
    """Distance of p from the line a-b to the inside of a triangle [px]."""
    side = b - a
    return wp.dot(perpendicular(side), p - a) / wp.max(wp.length(side), 1.0e-6)


@wp.func
def depth_in(scene: Scene, sample: Sample) -> float:
    """Distance to the nearest side of the triangle [px]."""
    first = scene.sides[sample.triangle, 0]
    second = scene.sides[sample.triangle, 1]
    corner = wp.vec2f(0.0, 0.0)
    p = sample.offset
    depth = wp.min(depth_from(corner, first, p), depth_from(first, second, p))
    return wp.min(depth, depth_from(second, corner, p))


@wp.func
def from_incentre(scene: Scene, sample: Sample) -> wp.vec2f:
    """Position seen from the centre of the incircle [px]."""
    circle = scene.incircles[sample.triangle]
    return sample.offset - wp.vec2f(circle[0], circle[1])


@wp.func
def inradius(scene: Scene, sample: Sample) -> float:
    """Radius of the incircle [px]."""
    return wp.max(scene.incircles[sample.triangle][2], 1.0e-3)


@wp.func
def chance(scene: Scene, triangle: int, number: int) -> float:
    """One of four numbers from 0 to below 1 that stay with a triangle."""
    return float((scene.hashes[triangle] >> wp.uint32(8 * number)) & wp.uint32(255)) / 256.0


@wp.func
def coverage_of(depth: float, pixel: float) -> float:
    """Part of a pixel that lies inside of a border at `depth` from its centre, both in px."""
    return wp.clamp(depth / pixel + 0.5, 0.0, 1.0)


@wp.func
def smooth_rise(share: float) -> float:
    """3 s^2 - 2 s^3 from 0 to 1, level at both ends."""
    s = wp.clamp(share, 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s)
