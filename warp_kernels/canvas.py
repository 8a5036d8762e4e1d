"""Every device array of one output, and the recorded launches that draw a mesh into it."""

from typing import Any

import numpy as np
import warp as wp

from warp_kernels.device import Device, Phase
from warp_kernels.edge_coverage import BAND, record_edge_coverage
from warp_kernels.gbuffer import record_gbuffer
from warp_kernels.layers import Affine, Layers, LayerTables
from warp_kernels.raster import MAX_SIDE
from warp_kernels.scene import Scene, StyleParameters
from warp_kernels.shade import record_shade
from warp_kernels.styles import Style

SAMPLES = 3
"""Samples per output pixel, across and down each; fewer where the sample grid would exceed what
coverage can count, see `raster.MAX_SIDE`."""
BAND_SAMPLES = 1 << 19
"""Samples of a band, for which triangles are found before they are shaded: 2 MB stay in cache."""


class Canvas:
    """Device memory for one output size and one stack of styles.

    Args:
        device: Where to run.
        picture: Width and height of the picture that the meshes cover [px].
        output: Width and height of the output [px], at most MAX_SIDE each.
        styles: Bottom to top.
    """

    def __init__(
        self,
        device: Device,
        picture: tuple[int, int],
        output: tuple[int, int],
        styles: tuple[Style, ...],
    ) -> None:
        self.device = device
        self.picture = picture
        self.output = output
        self.styles = styles
        self.samples = max(1, min(SAMPLES, MAX_SIDE // max(output)))
        width, height = output
        columns = width * self.samples
        self._band = max(1, min(height, BAND_SAMPLES // (columns * self.samples)))
        band = (self._band * self.samples, columns)
        self._triangle_of = device.empty(band, int)
        self._pixels = device.empty((height, width), wp.vec3ub)
        self._edge_count = device.empty(1, int)
        self._curved = device.empty(1, int)
        self._line_width = max((style.line_width for style in styles), default=0.0)
        shape = (height, width) if self._line_width else (1, 1)
        self._coverage = device.empty(shape, float)
        device.clear(self._coverage)
        packed = np.zeros((max(1, len(styles)), 8), dtype=np.float32)
        for row, style in zip(packed, styles, strict=False):
            row[: len(style.parameters())] = style.parameters()
        self._parameters = device.empty(len(packed), StyleParameters)
        device.write(self._parameters, packed)
        self._allocate(vertices=512, triangles=1024, layers=1024, links=1)

    def draw(
        self,
        *,
        vertices: np.ndarray,
        triangles: np.ndarray,
        edges: np.ndarray,
        colors: np.ndarray,
        gradients: np.ndarray,
        curvatures: np.ndarray | None,
        centres: np.ndarray,
        layers: Layers | None = None,
    ) -> np.ndarray:
        """Draw a mesh.

        Args:
            vertices: Positions [px of the picture], [V, 2].
            triangles: Corners, [T, 3].
            edges: Ends, [E, 2].
            colors: Mean colours of the triangles, then of the vanished ones that show through
                [code values], [M, 3].
            gradients: Change of colour to the right and down [code values / px], [M, 2, 3].
            curvatures: What quadratic colours add, see `Scene`, [M, 4, 3]; None for others.
            centres: Centroids [px of the picture], [M, 2].
            layers: What fading triangles let through; None where none fades, M is T then.

        Returns:
            Code values, [rows, columns, 3] uint8; a copy of its own.
        """
        self._reserve(
            vertices=len(vertices),
            triangles=len(triangles),
            layers=len(colors),
            links=1 if layers is None else len(layers.links),
        )
        if layers is not None:
            self._write_layers(layers)
        for array, values in (
            (self._vertices, vertices),
            (self._triangles, triangles),
            (self._edges, edges),
            (self._colors, colors),
            (self._gradients, gradients),
            (self._curved, np.array([0 if curvatures is None else 1])),
            (self._centres, centres),
            (self._edge_count, np.array([len(edges)])),
        ):
            self.device.write(array, values)
        if curvatures is not None:
            self.device.write(self._curvatures, curvatures)
        phases = []
        if self._line_width:
            self.device.clear(self._coverage)
            self._edge_drawing.resize(-(-self.output[1] // BAND), per_element=len(edges))
            phases.append(self._edge_drawing)
        for top, filling, shading in self._bands(fades=layers is not None):
            filling.resize(len(triangles))
            shading.resize(min(self._band, self.output[1] - top))
            phases += [filling, shading]
        self.device.run(phases)
        return self.device.read(self._pixels, self.output[1])

    def _write_layers(self, layers: Layers) -> None:
        """Hand over what shows through."""
        for name in ("weights", "maps", "spans", "links", "lines"):
            self.device.write(getattr(self._layers, name), getattr(layers, name))

    def _reserve(self, **counts: int) -> None:
        """Make room for so many of each kind, and some more."""
        if any(count > self._capacity[kind] for kind, count in counts.items()):
            grown = {
                kind: kept if counts[kind] <= kept else counts[kind] * 3 // 2
                for kind, kept in self._capacity.items()
            }
            self._allocate(**grown)

    def _allocate(self, *, vertices: int, triangles: int, layers: int, links: int) -> None:
        self._capacity = {
            "vertices": vertices,
            "triangles": triangles,
            "layers": layers,
            "links": links,
        }
        self._vertices = self._empty(vertices, wp.vec2d)
        self._triangles = self._empty(triangles, wp.vec3i)
        self._edges = self._empty(vertices + triangles + 1, wp.vec2i)
        self._colors = self._empty(layers, wp.vec3f)
        self._gradients = self._empty((layers, 2), wp.vec3f)
        self._curvatures = self._empty((layers, 4), wp.vec3f)
        self._centres = self._empty(layers, wp.vec2f)
        tables = LayerTables()
        tables.weights = self._empty(layers, float)
        tables.maps = self._empty(layers, Affine)
        tables.spans = self._empty(layers, wp.vec2i)
        tables.links = self._empty(links, int)
        tables.lines = self._empty(layers, wp.mat33f)
        self._layers = tables
        self._recorded: dict[bool, list[tuple[int, Phase, Phase]]] = {}
        self._edge_drawing = record_edge_coverage(
            self.device,
            vertices=self._vertices,
            edges=self._edges,
            edge_count=self._edge_count,
            scale=self._scale,
            half_width=0.5 * self._line_width * self._scale[1],
            coverage_out=self._coverage,
        )

    @property
    def _scale(self) -> tuple[float, float]:
        """Output pixels per pixel of the picture, across and down."""
        return self.output[0] / self.picture[0], self.output[1] / self.picture[1]

    def _bands(self, *, fades: bool) -> list[tuple[int, Phase, Phase]]:
        """The launches of every band; recorded anew once the arrays have moved.

        Most frames of a calm clip need no look through triangles, and stills never do: their
        kernel is not even compiled.
        """
        if fades not in self._recorded:
            tops = range(0, self.output[1], self._band)
            bands = [(top, *self._record_band(top, fades=fades)) for top in tops]
            self._recorded[fades] = bands
        return self._recorded[fades]

    def _record_band(self, top: int, *, fades: bool) -> tuple[Phase, Phase]:
        """Record what fills and what shades the band that begins with output row `top`."""
        scale = self._scale
        scene = Scene()
        scene.colors = self._colors
        scene.gradients = self._gradients
        scene.curvatures = self._curvatures
        scene.curved = self._curved
        scene.centres = self._centres
        scene.edge_coverage = self._coverage
        filling = record_gbuffer(
            self.device,
            vertices=self._vertices,
            triangles=self._triangles,
            scale=(scale[0] * self.samples, scale[1] * self.samples),
            first_row=top * self.samples,
            triangle_out=self._triangle_of,
        )
        shading = record_shade(
            self.device,
            shaders=tuple(style.shader for style in self.styles),
            samples=self.samples,
            scene=scene,
            parameters=self._parameters,
            layers=self._layers,
            fades=fades,
            triangle_of=self._triangle_of,
            picture_per_sample=(1 / (scale[0] * self.samples), 1 / (scale[1] * self.samples)),
            top=top,
            canvas_out=self._pixels,
        )
        return filling, shading

    def _empty(self, shape: Any, dtype: Any) -> wp.array:
        return self.device.empty(shape, dtype)
