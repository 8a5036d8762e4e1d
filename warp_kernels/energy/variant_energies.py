"""From moments to the energies of all variants of every triangle.

The energy follows from the forward substitution of the fit alone, without a second pass over
pixels.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.energy.fit import fit_moments
from warp_kernels.moments.due import triangle_is_due
from warp_kernels.moments.moment_layout import MomentLayout, moment_types
from warp_kernels.moments.triangle_sides import side_sums
from warp_kernels.moments.variants import DIRECTIONS, TRIANGLE_VARIANTS, first_version

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

SMALLEST_PART = 256
"""Triangles whose variants take about as long as waking up a second thread."""


@cache
def _edge_energy_kernel(layout: MomentLayout) -> Any:
    types = moment_types(layout)
    side_color, side_area = side_sums(layout)
    fit = fit_moments(layout)

    @wp.kernel(module="unique", module_options=EXACT)
    def solve_variants(
        span: wp.array(dtype=wp.vec2i),
        # In:
        triangles: wp.array(dtype=wp.vec3i),
        moved: wp.array(dtype=int),
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array3d(dtype=types.integer),
        area_sums: wp.array3d(dtype=types.integer),
        gauge: wp.array(dtype=wp.vec3d),
        # Out:
        energies_out: wp.array2d(dtype=wp.float64),
    ):
        """Solve the variants of one triangle, those that move one corner side by side."""
        triangle = span[0][0] + wp.tid()
        if triangle >= span[0][1]:
            return
        if not triangle_is_due(moved, triangles[triangle]):
            return  # the energies of a triangle at rest still stand
        side = sides[triangle]
        color = side_color(color_sums, side[0], 0) + side_color(color_sums, side[1], 0)
        area = side_area(area_sums, side[0], 0) + side_area(area_sums, side[1], 0)
        color += side_color(color_sums, side[2], 0)
        area += side_area(area_sums, side[2], 0)
        energies_out[triangle, 0] = fit(color, area, gauge[0]).energy
        for corner in range(3):
            after = side[corner]
            before = side[(corner + 2) % 3]
            across = side[(corner + 1) % 3]
            still_color = side_color(color_sums, across, 0)
            still_area = side_area(area_sums, across, 0)
            first = first_version(0, after & 1)
            last = first_version(1, before & 1)
            energies = wp.vec4d()
            direction = int(0)
            while direction < wp.static(DIRECTIONS):  # LLVM does all four at a time
                color = still_color + side_color(color_sums, after, first + direction)
                area = still_area + side_area(area_sums, after, first + direction)
                color += side_color(color_sums, before, last + direction)
                area += side_area(area_sums, before, last + direction)
                energies[direction] = fit(color, area, gauge[0]).energy
                direction += 1
            for n in range(wp.static(DIRECTIONS)):
                energies_out[triangle, 1 + wp.static(DIRECTIONS) * corner + n] = energies[n]

    return solve_variants


@cache
def _card_energy_kernel(layout: MomentLayout) -> Any:
    types = moment_types(layout)
    side_color, side_area = side_sums(layout)
    fit = fit_moments(layout)

    @wp.kernel(module="unique", module_options=EXACT)
    def solve_variant(
        span: wp.array(dtype=wp.vec2i),
        # In:
        triangles: wp.array(dtype=wp.vec3i),
        moved: wp.array(dtype=int),
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array3d(dtype=types.integer),
        area_sums: wp.array3d(dtype=types.integer),
        gauge: wp.array(dtype=wp.vec3d),
        # Out:
        energies_out: wp.array2d(dtype=wp.float64),
    ):
        """Solve one variant of one triangle: a card has more threads than a mesh has triangles."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        triangle = number / wp.static(TRIANGLE_VARIANTS)
        variant = number - triangle * wp.static(TRIANGLE_VARIANTS)
        if not triangle_is_due(moved, triangles[triangle]):
            return  # the energies of a triangle at rest still stand
        side = sides[triangle]
        corner = wp.max(variant - 1, 0) / wp.static(DIRECTIONS)
        direction = variant - 1 - corner * wp.static(DIRECTIONS)
        after = side[corner]
        before = side[(corner + 2) % 3]
        across = side[(corner + 1) % 3]
        first, last = int(0), int(0)  # the versions in which nothing is displaced
        if variant > 0:
            first = first_version(0, after & 1) + direction
            last = first_version(1, before & 1) + direction
        color = side_color(color_sums, across, 0) + side_color(color_sums, after, first)
        area = side_area(area_sums, across, 0) + side_area(area_sums, after, first)
        color += side_color(color_sums, before, last)
        area += side_area(area_sums, before, last)
        energies_out[triangle, variant] = fit(color, area, gauge[0]).energy

    return solve_variant


@cache
def _fragment_energy_kernel(layout: MomentLayout) -> Any:
    color_type, area_type = moment_types(layout).color, moment_types(layout).area
    fit = fit_moments(layout)

    @wp.kernel(module="unique", module_options=EXACT)
    def solve_variants(
        span: wp.array(dtype=wp.vec2i),
        # In:
        sides: wp.array(dtype=wp.vec3i),
        color_sums: wp.array2d(dtype=color_type),
        area_sums: wp.array2d(dtype=area_type),
        gauge: wp.array(dtype=wp.vec3d),
        # Out:
        energies_out: wp.array2d(dtype=wp.float64),
    ):
        """Solve one variant of one triangle."""
        number = span[0][0] + wp.tid()
        if number >= span[0][1]:
            return
        triangle = number / wp.static(TRIANGLE_VARIANTS)
        variant = number - triangle * wp.static(TRIANGLE_VARIANTS)
        best = fit(color_sums[triangle, variant], area_sums[triangle, variant], gauge[0])
        energies_out[triangle, variant] = best.energy

    return solve_variants


def energy_kernel(layout: MomentLayout, sums: str, *, on_card: bool = False) -> Any:
    """The kernel that solves variants, for moments that were summed in one of two ways."""
    if sums != "edges":
        return _fragment_energy_kernel(layout)
    return _card_energy_kernel(layout) if on_card else _edge_energy_kernel(layout)


def record_energies(
    device: Device,
    layout: MomentLayout,
    sums: str,
    *,
    triangles: wp.array,
    moved: wp.array,
    sides: wp.array,
    color_sums: wp.array,
    area_sums: wp.array,
    gauge: wp.array,
    energies_out: wp.array,
) -> Phase:
    """Prepare the launch that finds E of all thirteen variants of every triangle.

    Args:
        device: Where to run.
        layout: The polynomial colour and its integers.
        sums: "edges" or "fragments", the way in which the moments were summed.
        triangles: Corners, [T] vec3i. Not read with "fragments".
        moved: Marks of what has moved since the energies were found, see `due`, [V]; with "edges"
            those of a triangle at rest are left as they are.
        sides: For each side c of a triangle 2 * edge + (1 where the edge runs the other way),
            [T] vec3i. Not read with "fragments".
        color_sums: [E, 4 K, 9] integers with "edges", [T, 13] vectors with "fragments".
        area_sums: As `color_sums`.
        gauge: The scale of energies and the size of the picture, see `fit`, [1] vec3d.
        energies_out: E(T) [code value^2 px], [T, 13].

    Source: Lawonn & Guenther (2018), Eqs. 4, 13-15 (without the 1 / q of Eq. 13, so that energies
        add up, as Eq. 12 needs).
    """
    kernel = energy_kernel(layout, sums, on_card=device.is_cuda)
    inputs = [sides, color_sums, area_sums, gauge]
    if sums == "edges":
        inputs = [triangles, moved, *inputs]
    if sums == "edges" and not device.is_cuda:
        return device.record(kernel, inputs, [energies_out], smallest_part=SMALLEST_PART)
    return device.record(kernel, inputs, [energies_out], per_element=TRIANGLE_VARIANTS)
