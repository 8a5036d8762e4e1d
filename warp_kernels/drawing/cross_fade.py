"""How a pixel is seen in which a triangle is still fading in.

Such a pixel is looked at triangle by triangle; where a border is near beneath, at every sample.
There are few of them, each different from the next: they are looked at one by one.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.drawing.layers import LayerTables, Seen, fading_look
from warp_kernels.drawing.moved import MovedTables, resting
from warp_kernels.scene.scene import FAR, Scene, StyleParameters, extent_of

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def see_through(color_at: Any, samples: int, moves: bool) -> Any:
    """A wp.func that sees a pixel as a whole, triangle by triangle or sample by sample.

    Warp hands a scene over by value. Where a function is called at one place only the compiler
    puts it there and nothing is copied: so there is one loop for all three cases.

    Args:
        color_at: A wp.func `(Scene, parameters, Sample) -> vec4f`.
        samples: Samples of a pixel, across and down each.
        moves: Whether triangles are drawn elsewhere than they lie.
    """
    every = (1 << samples * samples) - 1
    look, point_in = fading_look(color_at), resting(moves)

    @wp.func
    def samples_in(line: wp.array(dtype=int), first: int, triangle: int) -> int:
        """The samples of a pixel that lie in a triangle, as bits."""
        width = line.shape[0] / wp.static(samples)
        found = int(0)
        for k in range(wp.static(samples * samples)):
            other = line[(k // samples) * width + first + k % samples]
            found += wp.where(other == triangle, 1 << k, 0)
        return found

    @wp.func
    def pixel_look(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        moved: MovedTables,
        line: wp.array(dtype=int),
        row: int,
        column: int,
    ) -> Seen:
        """The mean over the parts of the pixel."""
        first = column * wp.static(samples)
        width = line.shape[0] / wp.static(samples)
        middle = wp.vec2i(scene.columns[column], scene.rows[row])
        by_sample = bool(False)
        # as far as a pixel's corner is from its centre, also where a map stretches by a quarter
        near = 0.884 * scene.pixel
        seen = Seen()
        seen.clear = FAR
        left = int(wp.static(every))
        while left != 0:
            k = int(0)
            while (left >> k) & 1 == 0:
                k += 1
            triangle = line[(k / wp.static(samples)) * width + first + k % wp.static(samples)]
            own = wp.where(by_sample, left & -left, left & samples_in(line, first, triangle))
            left = left ^ own
            share = float(scene.parts[own, 2]) * wp.static(1.0 / samples**2)
            place = middle + wp.vec2i(scene.parts[own, 0], scene.parts[own, 1])
            extent = extent_of(scene, share, wp.static(samples))
            here = point_in(scene, moved, triangle, place, middle, extent)
            here.row = row
            here.column = column
            found = look(scene, parameters, layers, here)
            seen.color += share * found.color
            seen.opacity += share * found.opacity
            seen.clear = wp.min(seen.clear, found.clear)
            if left == 0 and not by_sample and seen.clear < near:
                by_sample = True
                left = wp.static(every)
                seen = Seen()
        return seen

    return pixel_look
