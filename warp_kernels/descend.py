"""One step of every vertex: gather dE/dv, add the other terms, move within the trust region."""

from functools import lru_cache
from typing import Any

import warp as wp

from warp_kernels.device import Device, Phase

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

HEIGHT_FRACTION = 0.4
"""Largest step as a part of the smallest height around. Below 1/2 no triangle can turn inside
out: its width shrinks by at most twice the largest step of its corners."""
LEAST_HEIGHT = 0.05
"""Heights do not shrink below this [px]: far above the 1/256 px to which coverage rounds."""

GROW = 1.2
SHRINK = 0.5
"""Change of a vertex's own trust region when a step keeps or reverses its direction."""


@wp.func
def smallest_height(a: wp.vec2d, b: wp.vec2d, c: wp.vec2d) -> wp.float64:
    """Smallest height of a triangle [px]."""
    ab = b - a
    bc = c - b
    ca = a - c
    doubled = wp.abs(ab[0] * ca[1] - ab[1] * ca[0])
    longest = wp.max(wp.max(wp.dot(ab, ab), wp.dot(bc, bc)), wp.dot(ca, ca))
    return doubled / wp.sqrt(wp.max(longest, wp.float64(1.0e-30)))


@wp.func
def newton_step(slope: wp.float64, curvature: wp.float64, reach: wp.float64) -> wp.float64:
    """The step to the minimum of a parabola, or as far downhill as allowed where it opens down."""
    if slope == wp.float64(0.0):
        return slope
    if wp.abs(slope) < curvature * reach:
        return -slope / curvature
    return -wp.sign(slope) * reach


@lru_cache(maxsize=None)
def _descend_kernel() -> Any:
    @wp.kernel(enable_backward=False, module="unique")
    def descend(
        begin: int,
        # In:
        vertices: wp.array(dtype=wp.vec2d),
        triangles: wp.array(dtype=wp.vec3i),
        energies: wp.array2d(dtype=wp.float64),
        fan_offsets: wp.array(dtype=int),
        fan_corners: wp.array(dtype=int),
        freedom: wp.array(dtype=wp.vec2d),
        anchors: wp.array(dtype=wp.vec3d),
        controls: wp.array(dtype=wp.float64),
        # In and out:
        memory_out: wp.array(dtype=wp.vec4d),
        # Out:
        vertices_out: wp.array(dtype=wp.vec2d),
    ):
        vertex = begin + wp.tid()
        trust = controls[0]
        regularity = controls[1]
        dead_band = controls[2]
        here = vertices[vertex]
        slope = wp.vec2d()
        curvature = wp.vec2d()
        ring = wp.vec2d()
        height = wp.float64(1.0e30)
        first = fan_offsets[vertex]
        last = fan_offsets[vertex + 1]
        for n in range(first, last):
            triangle = fan_corners[n] / 3
            corner = fan_corners[n] - 3 * triangle
            variant = 1 + 4 * corner
            still = energies[triangle, 0]
            for axis in range(2):
                plus = energies[triangle, variant + 2 * axis]
                minus = energies[triangle, variant + 2 * axis + 1]
                slope[axis] += wp.float64(0.5) * (plus - minus)
                curvature[axis] += plus + minus - wp.float64(2.0) * still
            corners = triangles[triangle]
            height = wp.min(
                height,
                smallest_height(
                    vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]
                ),
            )
            ring += vertices[corners[(corner + 1) % 3]] + vertices[corners[(corner + 2) % 3]]
        # every interior neighbour was met twice, so the mean over the ring is over 2 n
        to_ring = here - ring / wp.float64(2 * (last - first))
        anchor = anchors[vertex]
        pull = anchor[2]
        third = wp.float64(1.0 / 3.0)
        memory = memory_out[vertex]
        step = wp.vec2d()
        for axis in range(2):
            g = third * slope[axis] + regularity * to_ring[axis]
            g += pull * (here[axis] - anchor[axis])
            h = third * curvature[axis] + regularity + pull
            reach = wp.min(memory[axis], trust)
            s = newton_step(g, h, reach) * freedom[vertex][axis]
            if s * memory[axis + 2] < wp.float64(0.0):
                reach = reach * wp.float64(wp.static(SHRINK))
                s = newton_step(g, h, reach) * freedom[vertex][axis]
            else:
                reach = reach * wp.float64(wp.static(GROW))
            memory[axis] = reach
            memory[axis + 2] = s
            step[axis] = s
        floor = wp.float64(wp.static(LEAST_HEIGHT))
        spare = wp.max(height - floor, wp.float64(0.1) * height)
        limit = wp.min(trust, wp.float64(wp.static(HEIGHT_FRACTION)) * spare)
        length = wp.length(step)
        if length < dead_band:
            step = wp.vec2d()
        if length > limit:
            step = step * (limit / length)
        memory_out[vertex] = memory
        vertices_out[vertex] = here + step

    return descend


def record_descent(
    device: Device,
    *,
    vertices: wp.array,
    triangles: wp.array,
    energies: wp.array,
    fan_offsets: wp.array,
    fan_corners: wp.array,
    freedom: wp.array,
    anchors: wp.array,
    controls: wp.array,
    memory_out: wp.array,
    vertices_out: wp.array,
) -> Phase:
    """Prepare the launch that moves every vertex once, out of place.

    Args:
        device: Where to run.
        vertices: Positions before the step [px], [V] vec2d.
        triangles: Corners, [T] vec3i.
        energies: E of all variants [code value^2 px], [T, 13].
        fan_offsets: Where each vertex's corners begin in `fan_corners`, [V + 1].
        fan_corners: Corner numbers 3 t + c around each vertex, [3 T].
        freedom: 1 where a coordinate may change and 0 where the border holds it, [V] vec2d.
        anchors: Position [px] and weight [code value^2] of the temporal term, [V] vec3d.
        controls: Trust region [px], lambda [code value^2], shortest step that is taken [px], [3].
        memory_out: Each vertex's own trust region per axis [px] and its last step [px], read and
            written, [V] vec4d.
        vertices_out: Positions after the step [px], [V] vec2d.

    Source: Lawonn & Guenther (2018), Sec. 3.2 and 4.1, Eqs. 7-11.
    Deviation: a diagonal Newton step takes the place of a fixed step size, since the twelve
        variants give second differences as well; each vertex keeps a trust region of its own per
        axis, which grows while its steps agree and shrinks when they turn round; a step is also
        limited by the heights around, so that no triangle turns inside out; and a spring holds a
        vertex to where the optical flow took it.
    """
    inputs = [
        vertices, triangles, energies, fan_offsets, fan_corners, freedom, anchors, controls,
    ]  # fmt: skip
    return device.record(_descend_kernel(), inputs, [memory_out, vertices_out])
