"""What splits of edges would save, as a card finds it: a thread for every place on every edge.

The CPU's kernel tries the places of an edge one after the other. A card has more threads than a
mesh has edges, and too few registers for all that a thread would remember between them.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.energy.topology_gains import (
    IMPOSSIBLE,
    PLACES,
    SPLIT_PLACES,
    allowed,
    corner_after,
    corner_before,
    split_place,
)
from warp_kernels.energy.topology_inputs import ground_type
from warp_kernels.energy.triangle_energy import line_sums
from warp_kernels.moments.moment_layout import MomentLayout

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

TRIED = len(SPLIT_PLACES)
"""Places on an edge."""


@cache
def trial_kernel(layout: MomentLayout) -> Any:
    """The kernel that tries one place on one edge."""
    ground_struct = ground_type(layout)
    along, known, energy = line_sums(layout)

    @wp.kernel(module="unique", module_options=EXACT)
    def try_split(
        span: wp.array(dtype=wp.vec2i),
        # In:
        ground: ground_struct,
        # Out:
        trials_out: wp.array(dtype=wp.float64),
    ):
        """What the energy loses if one edge is split at one place."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        side = ground.half_edges[number / wp.static(TRIED)]
        twin = ground.twins[side]
        a = ground.vertices[ground.corners[side]]
        b = ground.vertices[ground.corners[corner_after(side)]]
        c = ground.vertices[ground.corners[corner_before(side)]]
        d = c
        gain = ground.energies[side / 3]
        if twin >= 0:
            d = ground.vertices[ground.corners[corner_before(twin)]]
            gain += ground.energies[twin / 3]
        places = wp.static(PLACES)
        place = number % wp.static(TRIED)
        m = split_place(a, b, c, d, places[place, 0], places[place, 1])
        possible = twin >= 0 or places[place, 1] == wp.float64(0.0)
        if twin >= 0:
            possible = allowed(m, a, d, ground.limits) and allowed(b, m, d, ground.limits)
        trials_out[number] = -wp.float64(wp.static(IMPOSSIBLE))
        if possible and allowed(a, m, c, ground.limits) and allowed(m, b, c, ground.limits):
            am = along(a, m, ground)
            mb = along(m, b, ground)
            mc = along(m, c, ground)
            gain -= energy(am, 1, mc, 1, known(corner_before(side), ground), 1, ground)
            gain -= energy(mb, 1, known(corner_after(side), ground), 1, mc, -1, ground)
            if twin >= 0:
                md = along(m, d, ground)
                gain -= energy(am, -1, known(corner_after(twin), ground), 1, md, -1, ground)
                gain -= energy(mb, -1, md, 1, known(corner_before(twin), ground), 1, ground)
            trials_out[number] = gain

    return try_split


@cache
def choice_kernel(layout: MomentLayout) -> Any:
    """The kernel that takes the best place on one edge, the first of equal ones."""
    ground_struct = ground_type(layout)

    @wp.kernel(module="unique", module_options=EXACT)
    def choose_split(
        span: wp.array(dtype=wp.vec2i),
        # In:
        ground: ground_struct,
        trials: wp.array(dtype=wp.float64),
        # Out:
        gains_out: wp.array(dtype=wp.float64),
        points_out: wp.array(dtype=wp.vec2d),
    ):
        """What the energy loses if one edge is split at the best of its places."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        side = ground.half_edges[number]
        twin = ground.twins[side]
        a = ground.vertices[ground.corners[side]]
        b = ground.vertices[ground.corners[corner_after(side)]]
        c = ground.vertices[ground.corners[corner_before(side)]]
        d = c
        if twin >= 0:
            d = ground.vertices[ground.corners[corner_before(twin)]]
        best = -wp.float64(wp.static(IMPOSSIBLE))
        point = wp.float64(0.5) * (a + b)
        places = wp.static(PLACES)
        place = int(0)
        while place < wp.static(TRIED):
            if trials[number * wp.static(TRIED) + place] > best:
                best = trials[number * wp.static(TRIED) + place]
                point = split_place(a, b, c, d, places[place, 0], places[place, 1])
            place += 1
        gains_out[number] = best
        points_out[number] = point

    return choose_split


def record_card_splits(
    device: Device,
    layout: MomentLayout,
    ground: Any,
    *,
    trials_out: wp.array,
    gains_out: wp.array,
    points_out: wp.array,
) -> tuple[Phase, Phase]:
    """Prepare the launches that measure splits, with the bits of the CPU's one.

    Args:
        device: Where to run.
        layout: The polynomial colour and its integers.
        ground: What is read, a `ground_type`.
        trials_out: Receives what each place saves [code value^2 px], [TRIED N] float64.
        gains_out: As `record_changes`.
        points_out: As `record_changes`.
    """
    trying = device.record(trial_kernel(layout), [ground], [trials_out], per_element=TRIED)
    inputs = [ground, trials_out]
    return trying, device.record(choice_kernel(layout), inputs, [gains_out, points_out])
