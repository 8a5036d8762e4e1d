"""What every possible flip, collapse and split would do to the energy: all candidates at once."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import warp as wp

from warp_kernels.descend import smallest_height
from warp_kernels.device import Device, Phase
from warp_kernels.moment_layout import MomentLayout, moment_types
from warp_kernels.triangle_energy import line_sums

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
    vertices: wp.array
    """Positions [px], [V] vec2d."""
    energies: wp.array
    """E(T) as it stands [code value^2 px], [T] float64."""
    sides: wp.array
    """For each side of a triangle 2 * edge + (1 where the edge runs the other way), [T] vec3i."""
    color_sums: wp.array
    """Colour moments left of every edge as it stands, [E, 1] vectors."""
    area_sums: wp.array
    """Area moments left of every edge, [E, 1] vectors."""
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


@wp.func
def corner_before(half_edge: int) -> int:
    """The previous half-edge of the same triangle."""
    return half_edge - half_edge % 3 + (half_edge + 2) % 3


@wp.func
def split_place(
    a: wp.vec2d, b: wp.vec2d, c: wp.vec2d, d: wp.vec2d, share: wp.float64, lift: wp.float64
) -> wp.vec2d:
    """One of `SPLIT_PLACES` on the edge a b or beside it, towards c or d [px]."""
    zero = wp.float64(0.0)
    m = a + share * (b - a)
    return m + wp.max(lift, zero) * (c - m) + wp.max(-lift, zero) * (d - m)


@cache
def _flip_kernel(layout: MomentLayout) -> Any:
    types = moment_types(layout)
    along, known, energy = line_sums(layout)

    @wp.kernel(enable_backward=False, module="unique")
    def flip_gains(
        span: wp.array(dtype=wp.vec2i),
        # In:
        half_edges: wp.array(dtype=int),
        twins: wp.array(dtype=int),
        corners: wp.array(dtype=int),
        vertices: wp.array(dtype=wp.vec2d),
        energies: wp.array(dtype=wp.float64),
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array2d(dtype=types.color),
        area_sums: wp.array2d(dtype=types.area),
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
            c = vertices[corners[corner_before(side)]]
            d = vertices[corners[corner_before(twin)]]
            if allowed(a, d, c, limits) and allowed(b, c, d, limits):
                bc = known(corner_after(side), sides, color_sums, area_sums)
                ca = known(corner_before(side), sides, color_sums, area_sums)
                ad = known(corner_after(twin), sides, color_sums, area_sums)
                db = known(corner_before(twin), sides, color_sums, area_sums)
                dc = along(d, c, table, powers, height)
                gains_out[number] = (
                    energies[side / 3]
                    + energies[twin / 3]
                    - energy(ad, 1, dc, 1, ca, 1, gauge[0])
                    - energy(bc, 1, dc, -1, db, 1, gauge[0])
                )

    return flip_gains


@cache
def _collapse_kernel(layout: MomentLayout) -> Any:
    types = moment_types(layout)
    along, known, energy = line_sums(layout)

    @wp.kernel(enable_backward=False, module="unique")
    def collapse_costs(
        span: wp.array(dtype=wp.vec2i),
        # In:
        half_edges: wp.array(dtype=int),
        twins: wp.array(dtype=int),
        corners: wp.array(dtype=int),
        vertices: wp.array(dtype=wp.vec2d),
        energies: wp.array(dtype=wp.float64),
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array2d(dtype=types.color),
        area_sums: wp.array2d(dtype=types.area),
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
        goal = corners[corner_after(side)]
        a = vertices[goal]
        cost = -energies[side / 3]
        # from triangle to triangle around the origin; the first holds the destination
        spoke = known(corner_after(side), sides, color_sums, area_sums)
        at = twins[corner_before(side)]
        while at >= 0 and corners[corner_before(at)] != goal:
            cost -= energies[at / 3]
            b = vertices[corners[corner_after(at)]]
            c = vertices[corners[corner_before(at)]]
            if not allowed(a, b, c, limits):
                cost += wp.float64(wp.static(IMPOSSIBLE))
            if cost < wp.float64(wp.static(0.5 * IMPOSSIBLE)):
                rim = known(corner_after(at), sides, color_sums, area_sums)
                following = along(a, c, table, powers, height)
                cost += energy(spoke, 1, rim, 1, following, -1, gauge[0])
                spoke = following
            at = twins[corner_before(at)]
        if at >= 0:
            cost -= energies[at / 3]  # the other one that holds the destination
        elif twins[side] >= 0:
            cost = wp.float64(wp.static(IMPOSSIBLE))  # a border vertex may not go inwards
        costs_out[number] = cost

    return collapse_costs


@cache
def _split_kernel(layout: MomentLayout) -> Any:
    types = moment_types(layout)
    along, known, energy = line_sums(layout)

    @wp.kernel(enable_backward=False, module="unique")
    def split_gains(
        span: wp.array(dtype=wp.vec2i),
        # In:
        half_edges: wp.array(dtype=int),
        twins: wp.array(dtype=int),
        corners: wp.array(dtype=int),
        vertices: wp.array(dtype=wp.vec2d),
        energies: wp.array(dtype=wp.float64),
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array2d(dtype=types.color),
        area_sums: wp.array2d(dtype=types.area),
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
        c = vertices[corners[corner_before(side)]]
        d = c
        before = energies[side / 3]
        if twin >= 0:
            d = vertices[corners[corner_before(twin)]]
            before += energies[twin / 3]
        bc = known(corner_after(side), sides, color_sums, area_sums)
        ca = known(corner_before(side), sides, color_sums, area_sums)
        ad = known(corner_after(wp.max(twin, 0)), sides, color_sums, area_sums)
        db = known(corner_before(wp.max(twin, 0)), sides, color_sums, area_sums)
        best = -wp.float64(wp.static(IMPOSSIBLE))
        point = wp.float64(0.5) * (a + b)
        for place in range(wp.static(len(SPLIT_PLACES))):
            lift = wp.float64(wp.static(SPLIT_PLACES[place][1]))
            m = split_place(a, b, c, d, wp.float64(wp.static(SPLIT_PLACES[place][0])), lift)
            possible = twin >= 0 or lift == wp.float64(0.0)  # a border vertex lies on the border
            if twin >= 0:
                possible = allowed(m, a, d, limits) and allowed(b, m, d, limits)
            if possible and allowed(a, m, c, limits) and allowed(m, b, c, limits):
                am = along(a, m, table, powers, height)
                mb = along(m, b, table, powers, height)
                mc = along(m, c, table, powers, height)
                gain = before - energy(am, 1, mc, 1, ca, 1, gauge[0])
                gain -= energy(mb, 1, bc, 1, mc, -1, gauge[0])
                if twin >= 0:
                    md = along(m, d, table, powers, height)
                    gain -= energy(am, -1, ad, 1, md, -1, gauge[0])
                    gain -= energy(mb, -1, md, 1, db, 1, gauge[0])
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
    picture = [
        arrays.sides,
        arrays.color_sums,
        arrays.area_sums,
        arrays.table,
        arrays.powers,
        arrays.gauge,
        height,
    ]
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
    mesh = [arrays.half_edges, arrays.twins, arrays.corners, arrays.vertices, arrays.energies]
    picture = [
        arrays.sides,
        arrays.color_sums,
        arrays.area_sums,
        arrays.table,
        arrays.powers,
        arrays.gauge,
        height,
    ]
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
    picture = [
        arrays.sides,
        arrays.color_sums,
        arrays.area_sums,
        arrays.table,
        arrays.powers,
        arrays.gauge,
        height,
    ]
    inputs = [*mesh, *picture, arrays.limits]
    outputs = [arrays.changes_out, arrays.points_out]
    return device.record(_split_kernel(layout), inputs, outputs)
