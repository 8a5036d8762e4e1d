"""What every possible flip, collapse and split would do to the energy: all candidates at once."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import warp as wp

from warp_kernels.descend import smallest_height
from warp_kernels.device import Device, Phase
from warp_kernels.moment_layout import MomentLayout, moment_types
from warp_kernels.triangle_energy import triangle_energy

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

IMPOSSIBLE = 1.0e30
"""Cost of a change that would turn a triangle inside out or make it too thin."""

SPLIT_PLACES = ((0.5, 0.0), (0.3, 0.0), (0.7, 0.0), (0.5, 0.3), (0.5, -0.3))
"""Where a new vertex is tried: how far along the edge, and from there how far towards the corner
across it, on the left (above 0) or on the right. Edges on the border use those on the edge."""


@dataclass(frozen=True, eq=False)
class SurveyArrays:
    """The mesh and the picture that changes are measured on, and where the results go."""

    half_edges: wp.array
    """The changes to look at, by a half-edge each, [N] int."""
    twins: wp.array
    """The half-edge that runs the other way, -1 on the border, [3 T] int."""
    corners: wp.array
    """Vertex number of every half-edge's origin, [3 T] int."""
    fan_offsets: wp.array
    """Where each vertex's corners begin in `fan_corners`, [V + 1] int."""
    fan_corners: wp.array
    """Corner numbers 3 t + c around each vertex, [3 T] int."""
    vertices: wp.array
    """Positions [px], [V] vec2d."""
    energies: wp.array
    """E(T) as it stands [code value^2 px], [T] float64."""
    table: wp.array
    """Prefix sums of the image, see `image_tables`."""
    powers: wp.array
    """Sums of x^a left of each column, [W + 1] vectors."""
    limits: wp.array
    """Smallest height [px] and largest area [px^2] of the triangles that a change makes, [2]."""
    gauge: wp.array
    """The scale of energies and the size of the picture, see `fit`."""
    changes_out: wp.array
    """Change of energy [code value^2 px], [N] float64; its sign is the launcher's."""
    points_out: wp.array
    """Where a split puts its vertex [px], [N] vec2d."""


@wp.func
def allowed(a: wp.vec2d, b: wp.vec2d, c: wp.vec2d, limits: wp.array(dtype=wp.float64)) -> bool:
    """Whether a new triangle is neither too thin nor too large."""
    doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    high = wp.sign(doubled) * smallest_height(a, b, c) >= limits[0]
    return high and doubled <= wp.float64(2.0) * limits[1]


@wp.func
def corner_after(half_edge: int) -> int:
    """The next half-edge of the same triangle."""
    return half_edge - half_edge % 3 + (half_edge + 1) % 3


@cache
def _flip_kernel(layout: MomentLayout) -> Any:
    types = moment_types(layout)
    energy = triangle_energy(layout)

    @wp.kernel(enable_backward=False, module="unique")
    def flip_gains(
        span: wp.array(dtype=wp.vec2i),
        # In:
        half_edges: wp.array(dtype=int),
        twins: wp.array(dtype=int),
        corners: wp.array(dtype=int),
        vertices: wp.array(dtype=wp.vec2d),
        energies: wp.array(dtype=wp.float64),
        table: wp.array(dtype=types.entry),
        powers: wp.array(dtype=types.powers),
        gauge: wp.array(dtype=wp.vec3d),
        height: int,
        limits: wp.array(dtype=wp.float64),
        # Out:
        gains_out: wp.array(dtype=wp.float64),
    ):
        """What the energy loses if one edge is flipped."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        side = half_edges[number]
        twin = twins[side]
        gains_out[number] = -wp.float64(wp.static(IMPOSSIBLE))
        if twin >= 0:
            a = vertices[corners[side]]
            b = vertices[corners[twin]]
            c = vertices[corners[corner_after(corner_after(side))]]
            d = vertices[corners[corner_after(corner_after(twin))]]
            if allowed(a, d, c, limits) and allowed(b, c, d, limits):
                gains_out[number] = (
                    energies[side / 3]
                    + energies[twin / 3]
                    - energy(a, d, c, table, powers, gauge[0], height)
                    - energy(b, c, d, table, powers, gauge[0], height)
                )

    return flip_gains


@cache
def _collapse_kernel(layout: MomentLayout) -> Any:
    types = moment_types(layout)
    energy = triangle_energy(layout)

    @wp.kernel(enable_backward=False, module="unique")
    def collapse_costs(
        span: wp.array(dtype=wp.vec2i),
        # In:
        half_edges: wp.array(dtype=int),
        corners: wp.array(dtype=int),
        fan_offsets: wp.array(dtype=int),
        fan_corners: wp.array(dtype=int),
        vertices: wp.array(dtype=wp.vec2d),
        energies: wp.array(dtype=wp.float64),
        table: wp.array(dtype=types.entry),
        powers: wp.array(dtype=types.powers),
        gauge: wp.array(dtype=wp.vec3d),
        height: int,
        limits: wp.array(dtype=wp.float64),
        # Out:
        costs_out: wp.array(dtype=wp.float64),
    ):
        """What the energy gains if the origin of one half-edge moves into its destination."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        side = half_edges[number]
        origin = corners[side]
        goal = corners[corner_after(side)]
        cost = wp.float64(0.0)
        for n in range(fan_offsets[origin], fan_offsets[origin + 1]):
            at = fan_corners[n]
            cost -= energies[at / 3]
            second = corners[corner_after(at)]
            third = corners[corner_after(corner_after(at))]
            if second != goal and third != goal:
                a = vertices[goal]
                b = vertices[second]
                c = vertices[third]
                if not allowed(a, b, c, limits):
                    cost += wp.float64(wp.static(IMPOSSIBLE))
                elif cost < wp.float64(wp.static(0.5 * IMPOSSIBLE)):
                    cost += energy(a, b, c, table, powers, gauge[0], height)
        costs_out[number] = cost

    return collapse_costs


@cache
def _split_kernel(layout: MomentLayout) -> Any:
    types = moment_types(layout)
    energy = triangle_energy(layout)

    @wp.kernel(enable_backward=False, module="unique")
    def split_gains(
        span: wp.array(dtype=wp.vec2i),
        # In:
        half_edges: wp.array(dtype=int),
        twins: wp.array(dtype=int),
        corners: wp.array(dtype=int),
        vertices: wp.array(dtype=wp.vec2d),
        energies: wp.array(dtype=wp.float64),
        table: wp.array(dtype=types.entry),
        powers: wp.array(dtype=types.powers),
        gauge: wp.array(dtype=wp.vec3d),
        height: int,
        limits: wp.array(dtype=wp.float64),
        # Out:
        gains_out: wp.array(dtype=wp.float64),
        points_out: wp.array(dtype=wp.vec2d),
    ):
        """What the energy loses if one edge is split at the best of several places."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        side = half_edges[number]
        twin = twins[side]
        a = vertices[corners[side]]
        b = vertices[corners[corner_after(side)]]
        c = vertices[corners[corner_after(corner_after(side))]]
        d = c
        before = energies[side / 3]
        if twin >= 0:
            d = vertices[corners[corner_after(corner_after(twin))]]
            before += energies[twin / 3]
        best = -wp.float64(wp.static(IMPOSSIBLE))
        point = wp.float64(0.5) * (a + b)
        for place in range(wp.static(len(SPLIT_PLACES))):
            lift = wp.float64(wp.static(SPLIT_PLACES[place][1]))
            m = a + wp.float64(wp.static(SPLIT_PLACES[place][0])) * (b - a)
            if wp.static(SPLIT_PLACES[place][1] > 0.0):
                m = m + lift * (c - m)
            if wp.static(SPLIT_PLACES[place][1] < 0.0):
                m = m - lift * (d - m)
            possible = allowed(a, m, c, limits) and allowed(m, b, c, limits)
            if twin >= 0:
                possible = possible and allowed(m, a, d, limits) and allowed(b, m, d, limits)
            elif wp.static(SPLIT_PLACES[place][1] != 0.0):
                possible = False
            if possible:
                gain = before - energy(a, m, c, table, powers, gauge[0], height)
                gain -= energy(m, b, c, table, powers, gauge[0], height)
                if twin >= 0:
                    gain -= energy(m, a, d, table, powers, gauge[0], height)
                    gain -= energy(b, m, d, table, powers, gauge[0], height)
                if gain > best:
                    best = gain
                    point = m
        gains_out[number] = best
        points_out[number] = point

    return split_gains


def record_flip_gains(
    device: Device, layout: MomentLayout, arrays: SurveyArrays, *, height: int
) -> Phase:
    """Prepare the launch that measures every flip.

    It writes the energy saved, -IMPOSSIBLE where there is no flip.

    Args:
        device: Where to run.
        layout: The polynomial colour and its integers.
        arrays: What is read and written; half-edges stand for their edges.
        height: Rows of the image [px].

    Deviation: the paper flips for the Delaunay property alone (Sec. 3.4).
    """
    mesh = [arrays.half_edges, arrays.twins, arrays.corners, arrays.vertices, arrays.energies]
    picture = [arrays.table, arrays.powers, arrays.gauge, height]
    inputs = [*mesh, *picture, arrays.limits]
    return device.record(_flip_kernel(layout), inputs, [arrays.changes_out])


def record_collapse_costs(
    device: Device, layout: MomentLayout, arrays: SurveyArrays, *, height: int
) -> Phase:
    """Prepare the launch that measures every half-edge collapse.

    It writes the energy added, half of IMPOSSIBLE or more where a triangle would fold.

    Args:
        device: Where to run.
        layout: The polynomial colour and its integers.
        arrays: What is read and written; the origins of half-edges move into their destinations.
        height: Rows of the image [px].

    Deviation: the paper collapses triangles of small area on their shortest edge (Sec. 3.4).
    """
    fans = [arrays.fan_offsets, arrays.fan_corners]
    mesh = [arrays.half_edges, arrays.corners, *fans, arrays.vertices, arrays.energies]
    picture = [arrays.table, arrays.powers, arrays.gauge, height]
    inputs = [*mesh, *picture, arrays.limits]
    return device.record(_collapse_kernel(layout), inputs, [arrays.changes_out])


def record_split_gains(
    device: Device,
    layout: MomentLayout,
    arrays: SurveyArrays,
    *,
    height: int,
) -> Phase:
    """Prepare the launch that measures the split of every edge at the best of `SPLIT_PLACES`.

    It writes the energy saved, -IMPOSSIBLE where a triangle would be too thin, and the place.

    Args:
        device: Where to run.
        layout: The polynomial colour and its integers.
        arrays: What is read and written; half-edges stand for their edges.
        height: Rows of the image [px].

    Deviation: the paper splits the triangles of the largest error at their centroids (Sec. 3.4).
    """
    mesh = [arrays.half_edges, arrays.twins, arrays.corners, arrays.vertices, arrays.energies]
    picture = [arrays.table, arrays.powers, arrays.gauge, height]
    inputs = [*mesh, *picture, arrays.limits]
    outputs = [arrays.changes_out, arrays.points_out]
    return device.record(_split_kernel(layout), inputs, outputs)
