"""Coordinates that belong to a triangle, for shaders: they move, turn and fade with it."""

import warp as wp

from warp_kernels.scene.scene import Sample, Scene, incentre_of, side_of

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def base_direction(scene: Scene, triangle: int) -> wp.vec2f:
    """Unit vector along the base edge."""
    base = side_of(scene, triangle, 0)
    return base / wp.max(wp.length(base), 1.0e-6)


@wp.func
def from_incentre(scene: Scene, sample: Sample) -> wp.vec2f:
    """Position seen from the centre of the incircle [px]."""
    return sample.offset - incentre_of(scene, sample.triangle)


@wp.func
def inradius(scene: Scene, sample: Sample) -> float:
    """Radius of the incircle [px]."""
    return wp.max(scene.incircles[sample.triangle, 2], 1.0e-3)


@wp.func
def chance(scene: Scene, triangle: int, number: int) -> float:
    """One of four numbers from 0 to below 1 that stay with a triangle."""
    return float((scene.hashes[triangle] >> wp.uint32(8 * number)) & wp.uint32(255)) / 256.0


@wp.func
def coverage_of(depth: float, extent: float) -> float:
    """Part of a small square that lies inside of a border at `depth` from its middle, both px."""
    # a stack asks for several borders at one extent: the inverse is worked out once
    return wp.clamp(depth * (1.0 / extent) + 0.5, 0.0, 1.0)


@wp.func
def line_coverage(distance: float, half_width: float, extent: float) -> float:
    """Part of a small square within `half_width` of a line at `distance` from its middle [px]."""
    outer = coverage_of(half_width - distance, extent)
    return outer - coverage_of(-half_width - distance, extent)


@wp.func
def distance_to_segment(p: wp.vec2f, a: wp.vec2f, b: wp.vec2f) -> float:
    """Distance from a point to a line segment [px]."""
    along = b - a
    t = wp.dot(p - a, along) / wp.max(wp.dot(along, along), 1.0e-12)
    return wp.length(p - a - wp.clamp(t, 0.0, 1.0) * along)


@wp.func
def smooth_rise(share: float) -> float:
    """3 s^2 - 2 s^3 from 0 to 1, level at both ends."""
    s = wp.clamp(share, 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s)
