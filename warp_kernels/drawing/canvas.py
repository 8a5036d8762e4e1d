"""Every device array of one output, and the recorded launches that draw a mesh into it."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.phase import Phase
from warp_kernels.drawing.band_lists import BandLists
from warp_kernels.drawing.coats import coats_of
from warp_kernels.drawing.gbuffer import (
    LEAST_ROWS,
    band_rows,
    fill_threads,
    fill_triangles,
    record_gbuffer,
)
from warp_kernels.drawing.layers import Layers, LayerTables
from warp_kernels.drawing.moved import MAP, Moved, MovedTables, clear_rows, record_clear, rows_of
from warp_kernels.drawing.paint import Paint, shapes_of
from warp_kernels.drawing.sample_points import LIST, parts_of_a_pixel
from warp_kernels.drawing.shade import record_shade, shading_kernel
from warp_kernels.drawing.store import channels_of
from warp_kernels.drawing.triangle_setup import prepare_kernel, record_prepare
from warp_kernels.limits import MAX_SIDE, SAMPLES
from warp_kernels.scene.places import centres, hashes_of, to_places
from warp_kernels.scene.scene import FIXED, Numbers, Scene, StyleParameters
from warp_kernels.scene.source_picture import reduced, step_for
from warp_kernels.scene.stroke_lay import own_lay
from warp_kernels.scene.texels import Texels, pack
from warp_kernels.styles import Style


class Canvas:
    """Device memory for one output size and one stack of styles.

    Args:
        device: Where to run.
        picture: Width and height of the picture that the meshes cover [px].
        output: Width and height of the output [px], at most MAX_SIDE each.
        styles: Bottom to top.
        masked: Styles over these, each inside of a mask.
        textures: What the shader of each style looks into, or None; masked ones last.
        followed: Numbers of the masked styles that are drawn on triangles of `Paint.shares`
            instead, in the order of these.
        moves: Whether triangles are drawn elsewhere than they lie.
        samples: Samples of an output pixel, across and down each, at most `MAX_SAMPLES`; fewer
            where their grid would exceed what coverage can count, see `MAX_SIDE`.
    """

    def __init__(
        self,
        device: Device,
        picture: tuple[int, int],
        output: tuple[int, int],
        styles: tuple[Style, ...],
        masked: tuple[Style, ...],
        textures: list[Texels | None],
        followed: tuple[int, ...] = (),
        moves: bool = False,
        samples: int = SAMPLES,
    ) -> None:
        self.device = device
        self.picture = picture
        self.output = output
        self.samples = max(1, min(samples, MAX_SIDE // max(output)))
        self._coats, self._moves = coats_of(styles, masked, followed, moves), moves
        self._masked, self._followed = len(masked) - len(followed), len(followed)
        self._is_even = all(style.is_even for style in styles) and not (masked or moves)
        styles = (*styles, *masked)
        self._has_ground = any(style.stays for style in styles)
        self._lays_strokes = any(style.lays_strokes for style in styles)
        self._prepares = {i: s.prepare for i, s in enumerate(styles) if s.prepare is not None}
        device.expect(self._kernels(fades=False))
        width, height = output
        columns = width * self.samples
        self._band = band_rows(device, output, self.samples)
        # a row more than there is: the last pixel's samples are read together with one that is not
        self._triangle_of = device.empty((self._band * self.samples + 1, columns), int)
        device.clear(self._triangle_of)  # where a mesh has holes, what stood there is looked up
        self._points = device.empty((1 if device.is_cuda else self._band, LIST), int)
        self.channels = channels_of(self._coats)
        """Numbers of a pixel: 3, or 4 with alpha."""
        self._pixels = device.empty((height, width, self.channels), wp.uint8)
        self._curved = device.empty(1, int)
        self._lists = BandLists(device, height, self._band)
        self._steady = self._steady_scene(needs_source=any(s.needs_source for s in styles))
        self._parameters = self._parameters_of(styles, textures)
        self._allocate(vertices=512, triangles=1024, layers=1024, links=1)

    def _kernels(self, *, fades: bool) -> list[Any]:
        """What drawing a frame launches, those first that take longest to compile."""
        shade = shading_kernel(self.device, self._coats, self.samples, fades)
        preparing = (prepare_kernel(prepare) for prepare in self._prepares.values())
        return [shade, *preparing, fill_triangles, *([clear_rows] if self._moves else [])]

    def _steady_scene(self, *, needs_source: bool) -> dict[str, Any]:
        """The parts of a scene that are the same for all frames."""
        width, height = self.picture
        step = step_for(self.picture, self.output)
        size = (-(-height // step), -(-width // step)) if needs_source else (1, 1)
        ground = self.output[::-1] if self._has_ground else (1, 1)
        across, down = self._scale
        sample_size = (FIXED / (across * self.samples), FIXED / (down * self.samples))
        return {
            "curved": self._curved,
            "source": self.device.empty(size, wp.vec3ub),
            "source_step": step,
            "masks": self.device.empty((max(1, self._masked * height), width), wp.uint8),
            "mask_rows": height,
            "columns": self._filled(centres(width, self.output[0]), int),
            "rows": self._filled(centres(height, self.output[1]), int),
            "pixel": float(np.sqrt((0.5 / np.square(self._scale)).sum())),
            "ground": self.device.empty(ground, wp.vec3ub),
            "parts": self._filled(parts_of_a_pixel(self.samples, sample_size), int),
        }

    def _parameters_of(self, styles: tuple[Style, ...], textures: list[Texels | None]) -> wp.array:
        """What the styles were asked for; their textures become a part of the scene."""
        texels, levels, self._levels_of = pack(textures)
        self._steady["texels"] = self._filled(texels, wp.uint8)
        self._steady["levels"] = self._filled(levels, int)
        return self._filled(self._packed(styles), StyleParameters)

    def restyle(self, styles: tuple[Style, ...], masked: tuple[Style, ...]) -> None:
        """Draw with other parameters from now on.

        Args:
            styles: As for the canvas, and of the same kind, see `stack_kind`.
            masked: The same.
        """
        self.device.write(self._parameters, self._packed((*styles, *masked)))

    def _packed(self, styles: tuple[Style, ...]) -> np.ndarray:
        """The parameters of styles as the device has them."""
        # rows of named numbers, as Warp says
        packed: Any = np.zeros(
            max(1, len(styles)),
            dtype=StyleParameters.numpy_dtype(),  # type: ignore[attr-defined]
        )
        packed["row"] = np.arange(len(packed))
        for kind in ("is_masked", "is_followed"):
            own = [row for row, coat in enumerate(self._coats) if getattr(coat, kind)]
            packed["mask"][own] = np.arange(len(own))
        for row, style, (first, count) in zip(packed, styles, self._levels_of, strict=False):
            numbers = style.numbers()
            row["numbers"].reshape(-1)[: len(numbers)] = numbers
            row["opacity"], row["first_level"], row["level_count"] = style.opacity, first, count
        return np.asarray(packed)

    def draw(
        self,
        *,
        vertices: np.ndarray,
        triangles: np.ndarray,
        paint: Paint,
        layers: Layers | None = None,
        source: np.ndarray | None = None,
        masks: Sequence[np.ndarray] = (),
        moved: Moved | None = None,
        ground: np.ndarray | None = None,
    ) -> np.ndarray:
        """Draw a mesh.

        Args:
            vertices: Positions [px of the picture], [V, 2].
            triangles: Corners, [T, 3].
            paint: The triangles, then the M - T vanished ones that show through.
            layers: What fading triangles let through; None where none fades, M is T then.
            source: The picture [code values], [H, W, 3] uint8; looked at if a style needs it.
            masks: For each masked style that is not followed where it is drawn (255) and where
                not (0), [H, W] uint8.
            moved: Where triangles are drawn; needed if they move.
            ground: What is seen behind them [code values], [rows, columns, 3] uint8; needed if a
                style stays.

        Returns:
            Code values, [rows, columns, 3] uint8, or [rows, columns, 4] with straight alpha if no
            style of the stack is opaque; a copy of its own.

        Raises:
            ValueError: If the paint does not say for every followed region which triangles it has.
        """
        self._check_shares(paint)
        if moved is not None:
            reach = MAX_SIDE / (self.samples * max(self._scale))
            rows = rows_of(moved, paint, layers, self.picture, reach)
            vertices, triangles = rows.vertices, rows.triangles
            paint, layers = rows.paint, rows.layers
        self._reserve(
            vertices=len(vertices),
            triangles=len(triangles),
            layers=len(paint.colors),
            links=1 if layers is None else len(layers.links),
        )
        if layers is not None:
            self._write_layers(layers)
        self.device.write(self._vertices, vertices)
        self.device.write(self._triangles, triangles)
        if self._lists.write(vertices, triangles, self._scale[1]):
            self._recorded.clear()
        self._write_paint(paint, shapes=not self._is_even or layers is not None)
        if moved is not None:
            self.device.write(self._moved.anchors, rows.anchors)
            self.device.write(self._moved.maps, rows.maps)
        if source is not None and self._steady["source"].size > 1:
            self.device.write(self._steady["source"], reduced(source, self._steady["source_step"]))
        if masks:
            self.device.write(self._steady["masks"], np.concatenate(masks))
        if ground is not None:
            self.device.write(self._steady["ground"], ground)
        counts = len(paint.colors), len(triangles)
        self.device.run(self._phases(*counts, fades=layers is not None))
        return self.device.read(self._pixels, self.output[1])

    def _phases(self, layers: int, triangles: int, *, fades: bool) -> list[Phase]:
        """What draws so many layers, some of them triangles of the frame."""
        phases = list(self._preparing)
        for preparing in phases:
            preparing.resize(layers)
        for top, *clearing, filling, shading in self._bands(fades=fades):
            rows = min(self._band, self.output[1] - top)
            for phase in (*clearing, shading):
                phase.resize(rows)
            filling.resize(rows, threads=fill_threads(self.device, triangles))
            phases += [*clearing, filling, shading]
        return phases

    def _check_shares(self, paint: Paint) -> None:
        """Refuse a paint without what followed styles look at: memory holds an earlier one's."""
        found = None if paint.shares is None else paint.shares.shape
        wanted = (len(paint.colors), self._followed)
        if self._followed and found != wanted:
            raise ValueError(f"shares of followed regions: {found}, and {wanted} are needed")

    def _write_paint(self, paint: Paint, *, shapes: bool) -> None:
        """Hand over colours, and shapes if they are looked at."""
        write, tables = self.device.write, self._tables
        write(tables["colors"], paint.colors)
        if self._followed and paint.shares is not None:
            write(tables["shares"], paint.shares)
        write(self._curved, np.array([0 if paint.curvatures is None else 1]))
        if paint.curvatures is not None:
            write(tables["curvatures"], paint.curvatures)
        if shapes:
            found = shapes_of(paint.corners)
            for name in ("anchors", "sides", "incircles", "lines"):
                write(tables[name], getattr(found, name))
            write(tables["gradients"], paint.gradients)
            write(tables["limits"], paint.limits)
            write(tables["hashes"], paint.hashes)
            if self._lays_strokes:
                lay = own_lay(paint.ids, paint.corners) if paint.lay is None else paint.lay
                write(tables["lay"], lay.table(found.anchors))
                write(tables["lay_hashes"], hashes_of(lay.owners))

    def _write_layers(self, layers: Layers) -> None:
        """Hand over what shows through."""
        for name in ("weights", "turns", "spans", "links"):
            self.device.write(getattr(self._layers, name), getattr(layers, name))
        self.device.write(self._layers.departures, to_places(layers.departures))

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
        self._tables = {
            "colors": self._empty((layers, 3), float),
            "gradients": self._empty((layers, 2), wp.vec3f),
            "curvatures": self._empty((layers, 4, 3), float),
            "limits": self._empty((layers, 2, 3), float),
            "anchors": self._empty(layers, wp.vec2i),
            "sides": self._empty((layers, 2, 2), float),
            "incircles": self._empty((layers, 3), float),
            "lines": self._empty(layers, wp.mat33f),
            "hashes": self._empty(layers, wp.uint32),
            "lay": self._empty((layers, 4), float),
            "lay_hashes": self._empty(layers, wp.uint32),
            "prepared": self._empty((len(self._parameters), layers), Numbers),
            "shares": self._empty((layers, max(1, self._followed)), wp.uint8),
        }
        tables = LayerTables()
        tables.weights = self._empty(layers, float)
        tables.turns = self._empty(layers, wp.mat22f)
        tables.departures = self._empty(layers, wp.vec2i)
        tables.spans = self._empty(layers, wp.vec2i)
        tables.links = self._empty(links, int)
        self._layers = tables
        self._moved = MovedTables()
        self._moved.anchors = self._empty(layers if self._moves else 1, wp.vec2i)
        self._moved.maps = self._empty((layers if self._moves else 1, MAP), float)
        self._recorded: dict[bool, list[tuple[Any, ...]]] = {}
        self._recorded_preparing: list[Phase] | None = None

    @property
    def _preparing(self) -> list[Phase]:
        """The launches that look at every triangle on behalf of a style."""
        if self._recorded_preparing is None:
            self._recorded_preparing = [
                record_prepare(
                    self.device,
                    prepare=prepare,
                    style=style,
                    scene=self._scene(),
                    parameters=self._parameters,
                    prepared_out=self._tables["prepared"],
                )
                for style, prepare in self._prepares.items()
            ]
        return self._recorded_preparing

    def _scene(self) -> Any:
        """Everything that shaders look at."""
        scene = Scene()
        for name, value in {**self._steady, **self._tables}.items():
            setattr(scene, name, value)
        return scene

    @property
    def _scale(self) -> tuple[float, float]:
        """Output pixels per pixel of the picture, across and down."""
        return self.output[0] / self.picture[0], self.output[1] / self.picture[1]

    def _bands(self, *, fades: bool) -> list[tuple[Any, ...]]:
        """The launches of every band; recorded anew once the arrays have moved.

        Most frames of a calm clip need no look through triangles, and stills never do: their
        kernel is not even compiled.
        """
        if fades not in self._recorded:
            tops = range(0, self.output[1], self._band)
            bands = [(top, *self._record_band(n, top, fades=fades)) for n, top in enumerate(tops)]
            self._recorded[fades] = bands
        return self._recorded[fades]

    def _record_band(self, band: int, top: int, *, fades: bool) -> tuple[Phase, ...]:
        """Record what empties, fills and shades the band that begins with output row `top`."""
        scale = self._scale
        filling = record_gbuffer(
            self.device,
            vertices=self._vertices,
            triangles=self._triangles,
            lists=self._lists,
            band=band,
            scale=(scale[0] * self.samples, scale[1] * self.samples),
            first_row=top * self.samples,
            samples=self.samples,
            triangle_out=self._triangle_of,
            overlaps=self._moves,
        )
        shading = record_shade(
            self.device,
            coats=self._coats,
            samples=self.samples,
            scene=self._scene(),
            parameters=self._parameters,
            layers=self._layers,
            fades=fades,
            moved=self._moved,
            triangle_of=self._triangle_of,
            top=top,
            flows_on=top + 2 * self._band <= self.output[1],
            points_out=self._points,
            canvas_out=self._pixels,
        )
        if not self._moves:
            return filling, shading
        clearing = record_clear(
            self.device,
            samples=self.samples,
            smallest_part=LEAST_ROWS,
            triangle_out=self._triangle_of,
        )
        return clearing, filling, shading

    def _empty(self, shape: Any, dtype: Any) -> wp.array:
        return self.device.empty(shape, dtype)

    def _filled(self, values: np.ndarray, dtype: Any) -> wp.array:
        """A device array of given values."""
        array = self.device.empty(values.shape if dtype is int else len(values), dtype)
        self.device.write(array, values)
        return array
