"""What lies beneath triangles that are still fading in: tables, and how a shader looks them up.

A layer is a triangle of the frame, or one that vanished a few frames ago. Layers are numbered
like triangles in everything that styles look at: first the frame's own, then the vanished ones,
each in the coordinates of the last frame that had it. Through a layer that is not opaque the
layers of the frame before its birth are seen, at the place that its material had there.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.scene import Sample, Scene, StyleParameters

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

FAR = wp.constant(1.0e30)
"""Farther from every border than any pixel [px]."""
Affine = wp.types.matrix(shape=(2, 3), dtype=wp.float32)
"""A map of the plane: its linear part, then where the origin goes."""


@dataclass(frozen=True, eq=False)
class Layers:
    """The tables of one frame, on the host."""

    weights: np.ndarray
    """Opacity of every layer, 1 for all that do not fade, [M] float32."""
    maps: np.ndarray
    """From a fading layer's frame to the frame before its birth [px], [M, 2, 3] float32."""
    spans: np.ndarray
    """Begin and end of what lies beneath in `links`, not empty if a layer fades, [M, 2] int32."""
    links: np.ndarray
    """Numbers of layers, [L] int32."""
    lines: np.ndarray
    """For the sides of a vanished layer (a, b, c): a x + b y + c is the distance from the side
    to the inside [px], [M, 3, 3] float32."""


@wp.struct
class LayerTables:
    """The same on the device."""

    weights: wp.array(dtype=float)
    maps: wp.array(dtype=Affine)
    spans: wp.array(dtype=wp.vec2i)
    links: wp.array(dtype=int)
    lines: wp.array(dtype=wp.mat33f)


@wp.func
def depth_inside(lines: wp.mat33f, point: wp.vec3f) -> float:
    """Distance to the nearest side of a layer [px], negative outside."""
    distances = lines * point
    return wp.min(wp.min(distances[0], distances[1]), distances[2])


@cache
def opaque_look(color_at: Any) -> Any:
    """A wp.func that sees the frame's own triangles alone.

    Args:
        color_at: A wp.func `(Scene, parameters, Sample) -> vec3f`.
    """

    @wp.func
    def look(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        sample: Sample,
    ) -> wp.vec4f:
        """Colour, and a distance from every border beneath: there is none."""
        color = color_at(scene, parameters, sample)
        return wp.vec4f(color[0], color[1], color[2], FAR)

    return look


@cache
def fading_look(color_at: Any) -> Any:
    """A wp.func that sees through the triangles that are not opaque yet.

    Args:
        color_at: A wp.func `(Scene, parameters, Sample) -> vec3f`.
    """

    @wp.func
    def look(
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        layers: LayerTables,
        sample: Sample,
    ) -> wp.vec4f:
        """Colour, and the distance from the nearest border beneath [px]."""
        color = color_at(scene, parameters, sample)
        weight = layers.weights[sample.triangle]
        if weight == 1.0:
            return wp.vec4f(color[0], color[1], color[2], FAR)
        color = weight * color
        seen = 1.0 - weight
        clear = float(FAR)
        here = Sample()
        here.triangle = sample.triangle
        here.position = sample.position
        here.row = sample.row
        here.column = sample.column
        while weight < 1.0:
            here.position = layers.maps[here.triangle] * wp.vec3f(
                here.position[0], here.position[1], 1.0
            )
            point = wp.vec3f(here.position[0], here.position[1], 1.0)
            span = layers.spans[here.triangle]
            # The one that holds the point; beyond the outline of all of them the nearest.
            here.triangle = layers.links[span[0]]
            deepest = depth_inside(layers.lines[here.triangle], point)
            place = span[0] + 1
            while place < span[1] and deepest <= 0.0:
                depth = depth_inside(layers.lines[layers.links[place]], point)
                if depth > deepest:
                    deepest = depth
                    here.triangle = layers.links[place]
                place += 1
            clear = wp.min(clear, deepest)
            weight = layers.weights[here.triangle]
            color += seen * weight * color_at(scene, parameters, here)
            seen *= 1.0 - weight
        return wp.vec4f(color[0], color[1], color[2], clear)

    return look
