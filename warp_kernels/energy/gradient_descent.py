"""One step of every vertex: gather dE/dv, add the other terms, move within the trust region."""

import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.moments.due import MOVED
from warp_kernels.raster import SUBPIXELS, to_fixed

wp.set_module_options(EXACT)

HEIGHT_FRACTION = 0.4
"""Largest step as a part of the smallest height around. Below 1/2 no triangle can turn inside
out: its width shrinks by at most twice the largest step of its corners."""
LEAST_HEIGHT = 0.3
"""Steps do not bring a height below this [px]: far above the 1/256 px to which coverage rounds, and
where slivers of a followed picture collapse, so that no vertex walks into its own collapse."""

GROW = 1.2
SHRINK = 0.5
"""Change of a vertex's own trust region when a step keeps or reverses its direction."""

_HEIGHT_FRACTION = wp.constant(HEIGHT_FRACTION)
_LEAST_HEIGHT = wp.constant(LEAST_HEIGHT)
_GROW = wp.constant(GROW)
_SHRINK = wp.constant(SHRINK)
_INVERSE_UNIT = wp.constant(1.0 / SUBPIXELS)
_THIRD = wp.constant(1.0 / 3.0)  # a triangle is visited from three corners: Eq. 7


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


@wp.struct
class Surroundings:
    """What a vertex feels of the triangles around it."""

    slope: wp.vec2d
    """Sum of dE(T)/dv [code value^2]."""
    curvature: wp.vec2d
    """Sum of the second differences of E(T) per axis [code value^2 / px]."""
    ring: wp.vec2d
    """Mean position of the neighbours [px]; at the border inner ones count twice."""
    height: wp.float64
    """Smallest height of a triangle around [px]."""


@wp.func
def look_around(
    vertex: int,
    vertices: wp.array(dtype=wp.vec2d),
    triangles: wp.array(dtype=wp.vec3i),
    energies: wp.array2d(dtype=wp.float64),
    fan_offsets: wp.array(dtype=int),
    fan_corners: wp.array(dtype=int),
    delta: wp.float64,
) -> Surroundings:
    """Gather over a vertex's corners, in a fixed order; `delta` is the variants' [px]."""
    around = Surroundings()
    around.height = wp.float64(1.0e30)
    half_inverse = wp.float64(0.5) / delta
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
            around.slope[axis] += half_inverse * (plus - minus)
            around.curvature[axis] += plus + minus - wp.float64(2.0) * still
        corners = triangles[triangle]
        a = vertices[corners[0]]
        b = vertices[corners[1]]
        c = vertices[corners[2]]
        around.height = wp.min(around.height, smallest_height(a, b, c))
        around.ring += vertices[corners[(corner + 1) % 3]] + vertices[corners[(corner + 2) % 3]]
    around.curvature = around.curvature / (delta * delta)
    # every inner neighbour was met twice; at the border the two outermost count half
    around.ring = around.ring / wp.float64(2 * (last - first))
    return around


@wp.func
def limited(
    step: wp.vec2d, trust: wp.float64, height: wp.float64, dead_band: wp.float64
) -> wp.vec2d:
    """A step no longer than trust and heights allow, and none below the dead band."""
    # beside a needle that is lower already there is next to no room, or it would fade away
    spare = wp.max(height - wp.float64(_LEAST_HEIGHT), wp.float64(0.005) * height)
    limit = wp.min(trust, wp.float64(_HEIGHT_FRACTION) * spare)
    length = wp.length(step)
    if length < dead_band:
        return wp.vec2d()
    if length > limit:
        return step * (limit / length)
    return step


@wp.kernel(enable_backward=False)
def descend(
    span: wp.array(dtype=wp.vec2i),
    # In:
    vertices: wp.array(dtype=wp.vec2d),
    triangles: wp.array(dtype=wp.vec3i),
    energies: wp.array2d(dtype=wp.float64),
    fan_offsets: wp.array(dtype=int),
    fan_corners: wp.array(dtype=int),
    freedom: wp.array(dtype=wp.vec2d),
    anchors: wp.array(dtype=wp.vec4d),
    probe: wp.array(dtype=int),
    controls: wp.array(dtype=wp.float64),
    # In and out:
    memory_out: wp.array(dtype=wp.vec4d),
    # Out:
    vertices_out: wp.array(dtype=wp.vec2d),
    moved_out: wp.array(dtype=int),
):
    """Move one vertex once."""
    vertex = span[0][0] + wp.tid()
    if vertex >= span[0][1]:
        return
    here = vertices[vertex]
    if wp.length_sq(freedom[vertex]) == wp.float64(0.0):
        vertices_out[vertex] = here
        moved_out[vertex] = 0
        return  # what lies around it need not be known
    trust = controls[0]
    regularity = controls[1]
    anchor = anchors[vertex]
    delta = wp.float64(probe[0]) * wp.float64(_INVERSE_UNIT)
    around = look_around(vertex, vertices, triangles, energies, fan_offsets, fan_corners, delta)
    to_ring = here - around.ring
    memory = memory_out[vertex]
    step = wp.vec2d()
    for axis in range(2):
        g = around.slope[axis] * wp.float64(_THIRD) + regularity * to_ring[axis]
        g += anchor[2] * (here[axis] - anchor[axis])
        h = around.curvature[axis] * wp.float64(_THIRD) + regularity + anchor[2]
        reach = wp.min(memory[axis], trust)
        s = newton_step(g, h, reach) * freedom[vertex][axis]
        if s * memory[axis + 2] < wp.float64(0.0):
            reach = reach * wp.float64(_SHRINK)
            s = newton_step(g, h, reach) * freedom[vertex][axis]
        else:
            reach = reach * wp.float64(_GROW)
        memory[axis] = reach
        memory[axis + 2] = s
        step[axis] = s
    memory_out[vertex] = memory
    dead_band = controls[2]
    if here[0] == anchor[0] and here[1] == anchor[1]:
        dead_band = wp.max(dead_band, anchor[3])  # at rest friction is larger than on the way
    there = here + limited(step, trust, around.height, dead_band)
    vertices_out[vertex] = there
    away = to_fixed(there) - to_fixed(here)
    moved_out[vertex] = wp.where(away[0] == 0 and away[1] == 0, 0, wp.static(MOVED))


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
    probe: wp.array,
    controls: wp.array,
    memory_out: wp.array,
    vertices_out: wp.array,
    moved_out: wp.array,
) -> Phase:
    """Prepare the launch that moves every vertex once, out of place.

    Args:
        device: Where to run.
        vertices: Positions before the step [px], [V] vec2d.
        triangles: Corners, [T] vec3i.
        energies: E of all variants [code value^2 px], [T, 13].
        fan_offsets: Where each vertex's corners begin in `fan_corners`, [V + 1].
        fan_corners: Corner numbers 3 t + c around each vertex, [3 T].
        freedom: 1 where a coordinate may change and 0 where the border holds it or the vertex
            rests, [V] vec2d.
        anchors: Position [px] and weight [code value^2] of the temporal term, and the shortest
            step that is taken away from there [px], [V] vec4d.
        probe: How far the variants' corners are displaced [1/256 px], [1].
        controls: Trust region [px], lambda [code value^2], shortest step that is taken [px], [3].
        memory_out: Each vertex's own trust region per axis [px] and its last step [px], read and
            written, [V] vec4d.
        vertices_out: Positions after the step [px], [V] vec2d.
        moved_out: `MOVED` where the step changes what a vertex covers, else 0, [V].

    Source: Lawonn & Guenther (2018), Sec. 3.2 and 4.1, Eqs. 7-11.
    Deviation: a diagonal Newton step takes the place of a fixed step size, since the twelve
        variants give second differences as well; each vertex keeps a trust region of its own per
        axis, which grows while its steps agree and shrinks when they turn round; a step is also
        limited by the heights around, so that no triangle turns inside out; a spring holds a
        vertex to where the optical flow took it, and friction while the picture stays as it
        is; and in Eq. 9 a border vertex weighs its inner
        neighbours twice and the two along the border once, for it meets them that often.
    """
    inputs = [
        vertices, triangles, energies, fan_offsets, fan_corners, freedom, anchors, probe,
        controls,
    ]  # fmt: skip
    return device.record(descend, inputs, [memory_out, vertices_out, moved_out])
