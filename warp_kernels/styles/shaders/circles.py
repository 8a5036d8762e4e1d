"""Every triangle packed with discs."""

import warp as wp

from warp_kernels.elementary import exponential, natural_log
from warp_kernels.scene.scene import (
    Ink,
    Sample,
    Scene,
    StyleParameters,
    color_of,
    incentre_of,
    side_of,
)
from warp_kernels.scene.triangle_frame import coverage_of, from_incentre, inradius

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def depth_in_chain(p: wp.vec2f, corner: wp.vec2f, radius: float, smallest: float) -> float:
    """Depth in the nearest disc of the chain from the incircle into a corner [px].

    Each disc touches the one before and the two sides: its radius and its distance from the
    corner are smaller by the same factor, so the disc at a distance is found by a logarithm.

    Args:
        p: The point, seen from the incentre [px].
        corner: The corner, seen from there [px].
        radius: The inradius [px].
        smallest: Radius below which discs are left out [px].
    """
    reach = wp.max(wp.length(corner), 1.0e-6)
    along = wp.dot(p, corner) / reach
    if along <= radius:
        return radius - wp.length(p)  # beside the incircle at most: most points are
    left = wp.max(reach - along, 1.0e-6)
    # between two discs the border lies where they touch: at reach - radius of the nearer one's way
    inner = wp.min(radius, 0.999 * reach)
    whole = reach + inner
    shrinking = natural_log((reach - inner) / whole)
    number = wp.ceil(natural_log(left / whole) / shrinking) - 1.0
    size = exponential(wp.max(number, 0.0) * shrinking)
    own = radius * size
    if own < smallest and number > 0.0:
        return -own
    return own - wp.length(p - (1.0 - size) * corner)


@wp.func
def packed_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The triangle's mean colour in the discs."""
    t = sample.triangle
    p = from_incentre(scene, sample)
    radius = inradius(scene, sample)
    centre = incentre_of(scene, t)
    smallest = parameters.numbers[1]
    depth = depth_in_chain(p, -centre, radius, smallest)
    depth = wp.max(depth, depth_in_chain(p, side_of(scene, t, 0) - centre, radius, smallest))
    depth = wp.max(depth, depth_in_chain(p, side_of(scene, t, 1) - centre, radius, smallest))
    ink = Ink()
    ink.color = color_of(scene, t)
    ink.opacity = 1.0
    depth -= 0.5 * parameters.numbers[0]
    ink.coverage = coverage_of(depth, sample.extent)
    return ink
