"""What lies beneath triangles that are still fading in: tables, and how a shader looks them up.

A layer is a triangle of the frame, or one that vanished a few frames ago. Layers are numbered
like triangles in everything that styles look at: first the frame's own, then the vanished ones,
each in the coordinates of the last frame that had it. Through a layer that is not opaque the
layers of the frame before its birth are seen, at the place that its material had there. As in a
`Scene` everything is seen from corner 0 of a layer, its anchor.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.scene.scene import (
    FAR,
    FIXED,
    Sample,
    Scene,
    StyleParameters,
    depth_inside,
    offset_of,
)

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@dataclass(frozen=True, eq=False)
class Layers:
    """The tables of one frame, on the host."""

    weights: np.ndarray
    """Opacity of every layer, 1 for all that do not fade, [M] float32."""
    turns: np.ndarray
    """What offsets in a fading layer were in the frame before its birth, [M, 2, 2] float32."""
    departures: np.ndarray
    """Where its anchor lay in that frame [px], [M, 2] float64."""
    spans: np.ndarray
    """Begin and end of what lies beneath in `links`, not empty if a layer fades, [M, 2] int32."""
    links: np.ndarray
    """Numbers of layers, [L] int32."""


@wp.struct
class LayerTables:
    """The same on the device."""

    weights: wp.array(dtype=float)
    turns: wp.array(dtype=wp.mat22f)
    departures: wp.array(dtype=wp.vec2i)
    spans: wp.array(dtype=wp.vec2i)
    links: wp.array(dtype=int)


@wp.struct
class Seen:
    """What is seen at a point."""

    color: wp.vec3f
    """Colour times opacity [code values]."""
    opacity: float
    """How much the styles hide of what is behind them all, 0 to 1."""
    clear: float
    """Distance from the nearest border beneath [px]."""


@wp.func
def departed(layers: LayerTables, sample: Sample) -> wp.vec2i:
    """Where a fading layer's material lay in the frame before its birth [2^-16 px]."""
    moved = FIXED * (layers.turns[sample.triangle] * sample.offset)
    at = layers.departures[sample.triangle]
    return wp.vec2i(at[0] + int(wp.rint(moved[0])), at[1] + int(wp.rint(moved[1])))


@wp.func
def layer_beneath(scene: Scene, layers: LayerTables, above: int, place: wp.vec2i) -> int:
    """The layer that holds a place under a fading one; beyond the outline of all the nearest."""
    span = layers.spans[above]
    found = layers.links[span[0]]
    deepest = depth_inside(scene.lines[found], offset_of(place, scene.anchors[found]))
    number = span[0] + 1
    while number < span[1] and deepest <= 0.0:
        other = layers.links[number]
        depth = depth_inside(scene.lines[other], offset_of(place, scene.anchors[other]))
        if depth > deepest:
            deepest = depth
            found = other
        number += 1
    return found


@cache
def fading_look(color_at: Any) -> Any:
    """A wp.func that sees through the triangles that are not opaque yet.

    Args:
        color_at: A wp.func `(Scene, parameters, Sample) -> vec4f`.
    """

    @wp.func
    def look(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        sample: Sample,
    ) -> Seen:
        """Colour, and the distance from the nearest border beneath [px]."""
        seen = Seen()
        seen.clear = FAR
        here = Sample()
        here.triangle = sample.triangle
        here.offset = sample.offset
        here.place = sample.place
        here.extent = sample.extent
        here.row = sample.row
        here.column = sample.column
        here.middle = sample.middle
        here.presence = sample.presence
        here.light = sample.light
        rest = float(1.0)
        while rest > 0.0:
            color = color_at(scene, parameters, here)
            weight = layers.weights[here.triangle]
            seen.color += rest * weight * color[3] * wp.vec3f(color[0], color[1], color[2])
            seen.opacity += rest * weight * color[3]
            rest *= 1.0 - weight
            if weight < 1.0:
                place = departed(layers, here)
                here.triangle = layer_beneath(scene, layers, here.triangle, place)
                here.offset = offset_of(place, scene.anchors[here.triangle])
                depth = depth_inside(scene.lines[here.triangle], here.offset)
                seen.clear = wp.min(seen.clear, depth)
        return seen

    return look
