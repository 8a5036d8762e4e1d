"""What every possible flip, collapse and split would do to the energy: all candidates at once."""

from collections.abc import Sequence
from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.energy.gradient_descent import smallest_height
from warp_kernels.energy.topology_inputs import ground_type
from warp_kernels.energy.triangle_energy import line_sums
from warp_kernels.moments.moment_layout import MomentLayout

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

IMPOSSIBLE = 1.0e30
"""Cost of a change that would turn a triangle inside out or make it too thin."""

SPLIT_PLACES = ((0.5, 0.0), (0.3, 0.0), (0.7, 0.0), (0.5, 0.3), (0.5, -0.3))
"""Where a new vertex is tried: how far along the edge, and from there how far towards the corner
across it, on the left (above 0) or on the right. Edges on the border use those on the edge."""

PLACES = wp.types.matrix(shape=(len(SPLIT_PLACES), 2), dtype=wp.float64)(
    *(number for place in SPLIT_PLACES for number in place)
)


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
    ground_struct = ground_type(layout)
    along, known, energy = line_sums(layout)

    @wp.kernel(module="unique", module_options=EXACT)
    def flip_gains(
        span: wp.array(dtype=wp.vec2i),
        # In:
        ground: ground_struct,
        # Out:
        gains_out: wp.array(dtype=wp.float64),
    ):
        """What the energy loses if one edge is flipped."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        side = ground.half_edges[number]
        twin = ground.twins[side]
        gains_out[number] = -wp.float64(wp.static(IMPOSSIBLE))
        if twin >= 0:
            a = ground.vertices[ground.corners[side]]
            b = ground.vertices[ground.corners[twin]]
            c = ground.vertices[ground.corners[corner_before(side)]]
            d = ground.vertices[ground.corners[corner_before(twin)]]
            if allowed(a, d, c, ground.limits) and allowed(b, c, d, ground.limits):
                bc = known(corner_after(side), ground)
                ca = known(corner_before(side), ground)
                ad = known(corner_after(twin), ground)
                db = known(corner_before(twin), ground)
                dc = along(d, c, ground)
                gains_out[number] = (
                    ground.energies[side / 3]
                    + ground.energies[twin / 3]
                    - energy(ad, 1, dc, 1, ca, 1, ground)
                    - energy(bc, 1, dc, -1, db, 1, ground)
                )

    return flip_gains


@cache
def _collapse_kernel(layout: MomentLayout) -> Any:
    ground_struct = ground_type(layout)
    along, known, energy = line_sums(layout)

    @wp.kernel(module="unique", module_options=EXACT)
    def collapse_costs(
        span: wp.array(dtype=wp.vec2i),
        # In:
        ground: ground_struct,
        # Out:
        costs_out: wp.array(dtype=wp.float64),
    ):
        """What the energy gains if the origin of one half-edge moves into its destination."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        side = ground.half_edges[number]
        goal = ground.corners[corner_after(side)]
        a = ground.vertices[goal]
        cost = -ground.energies[side / 3]
        # from triangle to triangle around the origin; the first holds the destination
        spoke = known(corner_after(side), ground)
        at = ground.twins[corner_before(side)]
        while at >= 0 and ground.corners[corner_before(at)] != goal:
            cost -= ground.energies[at / 3]
            b = ground.vertices[ground.corners[corner_after(at)]]
            c = ground.vertices[ground.corners[corner_before(at)]]
            if not allowed(a, b, c, ground.limits):
                cost += wp.float64(wp.static(IMPOSSIBLE))
            if cost < wp.float64(wp.static(0.5 * IMPOSSIBLE)):
                rim = known(corner_after(at), ground)
                following = along(a, c, ground)
                cost += energy(spoke, 1, rim, 1, following, -1, ground)
                spoke = following
            at = ground.twins[corner_before(at)]
        if at >= 0:
            cost -= ground.energies[at / 3]  # the other one that holds the destination
        elif ground.twins[side] >= 0:
            cost = wp.float64(wp.static(IMPOSSIBLE))  # a border vertex may not go inwards
        costs_out[number] = cost

    return collapse_costs


@cache
def _split_kernel(layout: MomentLayout) -> Any:
    ground_struct = ground_type(layout)
    along, known, energy = line_sums(layout)

    @wp.kernel(module="unique", module_options=EXACT)
    def split_gains(
        span: wp.array(dtype=wp.vec2i),
        # In:
        ground: ground_struct,
        # Out:
        gains_out: wp.array(dtype=wp.float64),
        points_out: wp.array(dtype=wp.vec2d),
    ):
        """What the energy loses if one edge is split at the best of several places."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        side = ground.half_edges[number]
        twin = ground.twins[side]
        a = ground.vertices[ground.corners[side]]
        b = ground.vertices[ground.corners[corner_after(side)]]
        c = ground.vertices[ground.corners[corner_before(side)]]
        d = c
        before = ground.energies[side / 3]
        if twin >= 0:
            d = ground.vertices[ground.corners[corner_before(twin)]]
            before += ground.energies[twin / 3]
        bc = known(corner_after(side), ground)
        ca = known(corner_before(side), ground)
        ad = known(corner_after(wp.max(twin, 0)), ground)
        db = known(corner_before(wp.max(twin, 0)), ground)
        best = -wp.float64(wp.static(IMPOSSIBLE))
        point = wp.float64(0.5) * (a + b)
        places = wp.static(PLACES)
        place = int(0)
        while place < wp.static(len(SPLIT_PLACES)):  # a loop takes a third of the time to compile
            lift = places[place, 1]
            m = split_place(a, b, c, d, places[place, 0], lift)
            possible = twin >= 0 or lift == wp.float64(0.0)  # a border vertex lies on the border
            if twin >= 0:
                possible = allowed(m, a, d, ground.limits) and allowed(b, m, d, ground.limits)
            if possible and allowed(a, m, c, ground.limits) and allowed(m, b, c, ground.limits):
                am = along(a, m, ground)
                mb = along(m, b, ground)
                mc = along(m, c, ground)
                gain = before - energy(am, 1, mc, 1, ca, 1, ground)
                gain -= energy(mb, 1, bc, 1, mc, -1, ground)
                if twin >= 0:
                    md = along(m, d, ground)
                    gain -= energy(am, -1, ad, 1, md, -1, ground)
                    gain -= energy(mb, -1, md, 1, db, 1, ground)
                if gain > best:
                    best = gain
                    point = m
            place += 1
        gains_out[number] = best
        points_out[number] = point

    return split_gains


CHANGES = {
    "flip": _flip_kernel,
    "collapse": _collapse_kernel,
    "split": _split_kernel,
}
"""The kernels by the names of the changes that they measure."""


def record_changes(
    device: Device, layout: MomentLayout, change: str, ground: Any, outputs: Sequence[wp.array]
) -> Phase:
    """Prepare the launch that measures all candidates for one kind of change.

    Args:
        device: Where to run.
        layout: The polynomial colour and its integers.
        change: A key of `CHANGES`. "flip" and "split" take half-edges for their edges and write the
            energy saved, -IMPOSSIBLE where there is no such change. "collapse" moves the origins of
            half-edges into their destinations and writes the energy added, half of IMPOSSIBLE or
            more where a triangle would fold or the border change.
        ground: What is read, a `ground_type`.
        outputs: Receive the change of energy [code value^2 px], [N] float64, and of a split its
            place among `SPLIT_PLACES` [px], [N] vec2d.

    Deviation: the paper flips for the Delaunay property, collapses triangles of small area on their
        shortest edge and splits those of the largest error at their centroids (Sec. 3.4).
    """
    return device.record(CHANGES[change](layout), [ground], outputs)
