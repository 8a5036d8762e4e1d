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
    gauge: wp.array
    """The scale of energies and the size of the picture, see `fit`."""
    changes_out: wp.array
    """Change of energy [code value^2 px], [N] float64; its sign is the launcher's."""


@wp.func
def signed_height(a: wp.vec2d, b: wp.vec2d, c: wp.vec2d) -> wp.float64:
    """Smallest height [px], negative where the triangle is turned inside out."""
    doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return wp.sign(doubled) * smallest_height(a, b, c)


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
        least_height: wp.float64,
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
            lower = wp.min(signed_height(a, d, c), signed_height(b, c, d))
            if lower >= least_height:
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
        least_height: wp.float64,
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
                if signed_height(a, b, c) < least_height:
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
        least_height: wp.float64,
        share: wp.float64,
        # Out:
        gains_out: wp.array(dtype=wp.float64),
    ):
        """What the energy loses if one edge is split at a point between its ends."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        side = half_edges[number]
        twin = twins[side]
        a = vertices[corners[side]]
        b = vertices[corners[corner_after(side)]]
        c = vertices[corners[corner_after(corner_after(side))]]
        m = a + share * (b - a)
        gain = energies[side / 3]
        lower = wp.min(signed_height(a, m, c), signed_height(m, b, c))
        if twin >= 0:
            d = vertices[corners[corner_after(corner_after(twin))]]
            gain += energies[twin / 3]
            lower = wp.min(lower, wp.min(signed_height(m, a, d), signed_height(b, m, d)))
            if lower >= least_height:
                gain -= energy(m, a, d, table, powers, gauge[0], height)
                gain -= energy(b, m, d, table, powers, gauge[0], height)
        if lower >= least_height:
            gain -= energy(a, m, c, table, powers, gauge[0], height)
            gain -= energy(m, b, c, table, powers, gauge[0], height)
        else:
            gain = -wp.float64(wp.static(IMPOSSIBLE))
        gains_out[number] = gain

    return split_gains


def record_flip_gains(
    device: Device, layout: MomentLayout, arrays: SurveyArrays, *, height: int, least_height: float
) -> Phase:
    """Prepare the launch that measures every flip.

    It writes the energy saved, -IMPOSSIBLE where there is no flip.

    Args:
        device: Where to run.
        layout: The polynomial colour and its integers.
        arrays: What is read and written; half-edges stand for their edges.
        height: Rows of the image [px].
        least_height: Smallest height that the new triangles may have [px].

    Deviation: the paper flips for the Delaunay property alone (Sec. 3.4).
    """
    mesh = [arrays.half_edges, arrays.twins, arrays.corners, arrays.vertices, arrays.energies]
    picture = [arrays.table, arrays.powers, arrays.gauge, height]
    inputs = [*mesh, *picture, wp.float64(least_height)]
    return device.record(_flip_kernel(layout), inputs, [arrays.changes_out])


def record_collapse_costs(
    device: Device, layout: MomentLayout, arrays: SurveyArrays, *, height: int, least_height: float
) -> Phase:
    """Prepare the launch that measures every half-edge collapse.

    It writes the energy added, half of IMPOSSIBLE or more where a triangle would fold.

    Args:
        device: Where to run.
        layout: The polynomial colour and its integers.
        arrays: What is read and written; the origins of half-edges move into their destinations.
        height: Rows of the image [px].
        least_height: Smallest height that the changed triangles may have [px].

    Deviation: the paper collapses triangles of small area on their shortest edge (Sec. 3.4).
    """
    fans = [arrays.fan_offsets, arrays.fan_corners]
    mesh = [arrays.half_edges, arrays.corners, *fans, arrays.vertices, arrays.energies]
    picture = [arrays.table, arrays.powers, arrays.gauge, height]
    inputs = [*mesh, *picture, wp.float64(least_height)]
    return device.record(_collapse_kernel(layout), inputs, [arrays.changes_out])


def record_split_gains(
    device: Device,
    layout: MomentLayout,
    arrays: SurveyArrays,
    *,
    height: int,
    least_height: float,
    share: float,
) -> Phase:
    """Prepare the launch that measures the split of every edge at one place.

    It writes the energy saved, -IMPOSSIBLE where a triangle would be too thin.

    Args:
        device: Where to run.
        layout: The polynomial colour and its integers.
        arrays: What is read and written; half-edges stand for their edges.
        height: Rows of the image [px].
        least_height: Smallest height that the new triangles may have [px].
        share: Where between origin (0) and destination (1) of the half-edge.

    Deviation: the paper splits the triangles of the largest error at their centroids (Sec. 3.4).
    """
    mesh = [arrays.half_edges, arrays.twins, arrays.corners, arrays.vertices, arrays.energies]
    picture = [arrays.table, arrays.powers, arrays.gauge, height]
    inputs = [*mesh, *picture, wp.float64(least_height), wp.float64(share)]
    return device.record(_split_kernel(layout), inputs, [arrays.changes_out])
