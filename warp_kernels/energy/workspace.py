"""Every device array of one job, and the only owner of device memory.

Arrays grow by half when a mesh outgrows them and are never shrunk, so a clip's frames find
everything in place: nothing is allocated or converted inside an optimisation round.
"""

from typing import Any

import numpy as np
import warp as wp

from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device
from warp_kernels.device.phase import Phase
from warp_kernels.device.staging import ArrayRows
from warp_kernels.energy.fit import record_fit
from warp_kernels.energy.freedom import Freedom
from warp_kernels.energy.gradient_descent import record_descent
from warp_kernels.energy.variant_energies import record_energies
from warp_kernels.moments.edge_moments import record_edge_moments
from warp_kernels.moments.fragments import record_fragment_moments
from warp_kernels.moments.moment_layout import layout_of_moments, moment_types
from warp_kernels.moments.pixel_moments import check_size
from warp_kernels.moments.pixel_weights import write_weights
from warp_kernels.moments.prefix_tables import record_image_tables, table_length
from warp_kernels.moments.variants import EDGE_VERSIONS, TRIANGLE_VARIANTS
from warp_kernels.raster import SUBPIXELS

FAR = 1e6
"""First trust region of a vertex [px]: the common one rules until steps turn round."""
DISPLACEMENT = 1.0
"""Distance between a triangle and its variants [px]: Delta of Eq. 11."""


class Workspace:
    """Device memory for one picture and one mesh, and the recorded launches over it.

    Args:
        device: Where to run.
        size: Width and height of the picture [px].
        model: The colour model to optimise.
        sums: "edges", or "fragments" for the paper's own way.
        weighted: Whether pictures come with weights.

    Raises:
        OptionError: If the picture is so large that a sum could leave its integers.
    """

    def __init__(
        self,
        device: Device,
        size: tuple[int, int],
        model: ColorModel,
        sums: str = "edges",
        weighted: bool = False,
    ) -> None:
        check_size(*size)
        self.device = device
        self.size = size
        self.model = model
        self.sums = sums
        self.weighted = weighted
        self.layout = layout_of_moments(model, weighted=weighted)
        width, height = size
        types = moment_types(self.layout)
        self.pixels = self._empty((height, width), wp.vec3ub)
        self._weights = self._empty((height, width) if self.layout.wide else (1, 1), wp.uint8)
        self.gauge = self._empty(1, wp.vec3d)
        write_weights(device, None, size, weights_out=self._weights, gauge_out=self.gauge)
        self.table = self._empty(table_length(width, height, self.layout), types.entry)
        self._controls, self._probe = self._empty(3, wp.float64), self._empty(1, wp.int32)
        self._displacement = 0.0
        self._tables = record_image_tables(
            device, self.layout, pixels=self.pixels, weights=self._weights, table_out=self.table
        )
        self._counts = (0, 0, 0)
        self.generation = 0
        """How often the arrays have moved: what was recorded over them before is void."""
        self._front = 0
        self.placed: object = None
        """The mesh that lies here, as its owner knows it, over the picture at hand."""
        self._held = self._fitted = False
        self._seen: list[np.ndarray] | None = None
        self._allocate(vertices=512, triangles=1024)

    def load_image(self, pixels: np.ndarray, weights: np.ndarray | None = None) -> None:
        """Take in a picture and build its prefix tables.

        Only ratios of weights matter; all equal ones give the bits that no weights give.

        Args:
            pixels: Code values, [H, W, 3] uint8.
            weights: How much the error of every pixel counts, 1 to 255 with 0 taken as 1, [H, W]
                uint8; None for all alike.

        Raises:
            ValueError: If the workspace takes no weights or they do not fit the picture.

        Deviation: the paper has no weights.
        """
        self.placed = None  # what was summed along edges belongs to the picture before
        self._fitted = False
        self.device.write(self.pixels, pixels)
        if self.weighted:
            write_weights(
                self.device, weights, self.size, weights_out=self._weights, gauge_out=self.gauge
            )
        elif weights is not None:
            raise ValueError("this workspace takes no weights; make it with weighted=True")
        self.device.run([self._tables])

    def load_mesh(
        self,
        *,
        vertices: np.ndarray,
        triangles: np.ndarray,
        edges: np.ndarray,
        sides: np.ndarray,
        fan_offsets: np.ndarray,
        fan_corners: np.ndarray,
        freedom: np.ndarray,
    ) -> None:
        """Take in a mesh, to be measured; `hold` prepares it for iterations.

        Args:
            vertices: Positions [px], [V, 2].
            triangles: Corners, [T, 3].
            edges: Ends of every edge, [E, 2].
            sides: 2 * edge + (1 where the edge runs the other way), [T, 3].
            fan_offsets: Beginning of each vertex's corners, [V + 1].
            fan_corners: Corners 3 t + c by vertex, [3 T].
            freedom: 1 where a coordinate may change, else 0, [V, 2].
        """
        self.placed, self._seen, self._held, self._fitted = None, None, False, False
        self._counts, self._front = (len(vertices), len(triangles), len(edges)), 0
        self._grow()
        write = self.device.write
        write(self._vertices[0], vertices)
        write(self.triangles, triangles)
        write(self._edges, edges)
        write(self.sides, sides)
        write(self._fan_offsets, fan_offsets)
        write(self._fan_corners, fan_corners)
        self._freedom.load(freedom)
        self._resize()

    def hold(self, anchors: np.ndarray, marks: np.ndarray | None = None) -> None:
        """Fix the temporal term, and forget the steps that vertices took before.

        Args:
            anchors: Place [px], weight [code value^2], shortest step away [px], [V, 4].
            marks: Which vertices rest, see `Freedom.rest`; None for none.
        """
        self._held = True
        self._freedom.rest(marks)
        self.device.write(self._anchors, anchors)
        self.device.write(self._memory, np.tile((FAR, FAR, 0.0, 0.0), (self._counts[0], 1)))

    def iterate(
        self,
        times: int,
        *,
        trust: float,
        regularity: float,
        dead_band: float = 0.0,
        displacement: float = DISPLACEMENT,
    ) -> None:
        """Run whole iterations: moments, energies, gradient, step.

        Args:
            times: Iterations.
            trust: Longest step [px].
            regularity: lambda of Eq. 7 [code value^2].
            dead_band: Shorter steps are not taken [px].
            displacement: Delta of Eq. 11, a multiple of 1/256 [px]; a small one finds the very
                place of an edge, a large one sees farther.
        """
        if not self._held:
            raise ValueError("a mesh was placed and not held; see `hold`")
        self.placed, self._fitted, self._seen = None, False, None
        self._displace(displacement)
        self.device.write(self._controls, np.array([trust, regularity, dead_band]))
        steps = zip(self._moments, self._descents, strict=True)
        there, back = ([moments, self._energy, descent] for moments, descent in steps)
        if times and self._front == 1:
            self.device.run(back)
            self._front, times = 0, times - 1
        self.device.run(there + back, times // 2)
        if times % 2:
            self.device.run(there)
            self._front = 1

    @property
    def standing(self) -> wp.array:
        """The vertices as they stand now, [V] vec2d on the device."""
        return self._vertices[self._front]

    def vertices(self) -> np.ndarray:
        """Positions as they stand now [px], [V, 2] float64."""
        return self._looked()[0]

    def energies(self) -> np.ndarray:
        """E of all thirteen variants of every triangle as it stands, 1 px apart, [T, 13]."""
        self._displace(DISPLACEMENT)
        self._freedom.know_all()
        self.device.run([self._moments[self._front], self._energy])
        self._seen = None
        return self.device.read(self._energies, self._counts[1])

    def last_energy(self) -> float:
        """Energy of the mesh before the last step of `iterate` [code value^2 px], if none rests."""
        return float(self._looked()[1].sum())

    def _looked(self) -> list[np.ndarray]:
        """Vertices and energies, read at once: a second copy takes a card as long as the first."""
        if self._seen is None:
            wanted = ArrayRows(self._energies, self._counts[1], column=0)
            self._seen = self.device.read_all([ArrayRows(self.standing, self._counts[0]), wanted])
        return self._seen

    def moments(self) -> tuple[np.ndarray, np.ndarray]:
        """Colour and area sums as they stand: [E, ., 9] with edges, [T, 13, .] with fragments.

        int64; in the wide layout the highest powers modulo 2^64.
        """
        self._displace(DISPLACEMENT)
        self._freedom.know_all()
        self.device.run([self._moments[self._front]])
        count = self._counts[2 if self.sums == "edges" else 1]
        sums = (self._color_sums, self._area_sums)
        read = self.device.read_all([ArrayRows(array, count) for array in sums])
        return read[0].view(np.int64), read[1].view(np.int64)

    def fit(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Best colours of the mesh as it stands; asked for again they are only read.

        Returns:
            Coefficients [T, 3, K] float64, energies [T] float64, and counts [T] int64: the pixels
            covered, or with weights the sum of theirs after division by the common divisor.
        """
        if not self._fitted:
            self.device.run([self._fit_sums[self._front], self._fit])
            self._fitted = True
        fitted, T = (self._coefficients, self.fit_energies, self._fit_counts), self._counts[1]
        coefficients, energies, counts = self.device.read_all([ArrayRows(a, T) for a in fitted])
        return coefficients, energies, counts

    def _displace(self, displacement: float) -> None:
        """Set the distance of the variants; sums taken at another one are void."""
        if displacement != self._displacement:
            self._displacement = displacement
            self.device.write(self._probe, np.array([round(displacement * SUBPIXELS)], np.int32))
            self._freedom.know_nothing()

    def _grow(self) -> None:
        had, needed = np.array(self.capacity), np.array(self._counts[:2])
        if (needed > had).any():
            vertices, triangles = np.maximum(had, needed * 3 // 2).tolist()
            self._allocate(vertices=vertices, triangles=triangles)

    def _allocate(self, *, vertices: int, triangles: int) -> None:
        self.capacity = (vertices, triangles)
        """Vertices and triangles that the arrays hold."""
        self.generation += 1
        edges = vertices + triangles + 1  # Euler: E = V + T - 1 in a disc
        types = moment_types(self.layout)
        self._vertices = (self._empty(vertices, wp.vec2d), self._empty(vertices, wp.vec2d))
        self.triangles = self._empty(triangles, wp.vec3i)
        self._edges = self._empty(edges, wp.vec2i)
        self.sides = self._empty(triangles, wp.vec3i)
        self._fan_offsets = self._empty(vertices + 1, wp.int32)
        self._fan_corners = self._empty(3 * triangles, wp.int32)
        self._freedom = Freedom(self.device, vertices)
        self._anchors = self._empty(vertices, wp.vec4d)
        self._memory = self._empty(vertices, wp.vec4d)
        if self.sums == "fragments":
            self._color_sums = self._empty((triangles, TRIANGLE_VARIANTS), types.color)
            self._area_sums = self._empty((triangles, TRIANGLE_VARIANTS), types.area)
        else:
            self._color_sums, self._area_sums = self._edge_sums(edges, EDGE_VERSIONS)
        self._energies = self._empty((triangles, TRIANGLE_VARIANTS), wp.float64)
        self.fit_color_sums, self.fit_area_sums = self._edge_sums(edges, 1)
        self._coefficients = self._empty((triangles, 3, self.model.term_count), wp.float64)
        self.fit_energies = self._empty(triangles, wp.float64)
        self._fit_counts = self._empty(triangles, wp.int64)
        self._record_iteration()  # the arrays have moved
        self._record_fit()

    def _edge_sums(self, edges: int, versions: int) -> tuple[wp.array, wp.array]:
        """Arrays for the colour and area moments of edges."""
        integer = moment_types(self.layout).integer
        counts = (4 * self.model.term_count, self.model.area_count)
        color, area = (self._empty((edges, count, versions), integer) for count in counts)
        return color, area

    def _record_iteration(self) -> None:
        """Moments, energies and steps; steps go to and fro between two arrays of vertices."""
        self._moments = [self._record_moments(front) for front in self._vertices]
        self._energy = record_energies(
            self.device,
            self.layout,
            self.sums,
            triangles=self.triangles,
            moved=self._freedom.marks,
            sides=self.sides,
            color_sums=self._color_sums,
            area_sums=self._area_sums,
            gauge=self.gauge,
            energies_out=self._energies,
        )
        self._descents = [
            record_descent(
                self.device,
                vertices=self._vertices[front],
                triangles=self.triangles,
                energies=self._energies,
                fan_offsets=self._fan_offsets,
                fan_corners=self._fan_corners,
                freedom=self._freedom.axes,
                anchors=self._anchors,
                probe=self._probe,
                controls=self._controls,
                memory_out=self._memory,
                vertices_out=self._vertices[1 - front],
                moved_out=self._freedom.marks,
            )
            for front in (0, 1)
        ]

    def _record_fit(self) -> None:
        """Colours of the mesh as it stands, from either array of vertices."""
        self._fit_sums = [
            record_edge_moments(
                self.device,
                self.layout,
                vertices=front,
                edges=self._edges,
                moved=self._freedom.marks,
                probe=self._probe,
                table=self.table,
                size=self.size,
                color_out=self.fit_color_sums,
                area_out=self.fit_area_sums,
                versions=1,
            )
            for front in self._vertices
        ]
        self._fit = record_fit(
            self.device,
            self.layout,
            sides=self.sides,
            color_sums=self.fit_color_sums,
            area_sums=self.fit_area_sums,
            gauge=self.gauge,
            size=self.size,
            coefficients_out=self._coefficients,
            energies_out=self.fit_energies,
            counts_out=self._fit_counts,
        )

    def _record_moments(self, vertices: wp.array) -> Phase:
        if self.sums == "fragments":
            return record_fragment_moments(
                self.device,
                self.layout,
                vertices=vertices,
                triangles=self.triangles,
                probe=self._probe,
                pixels=self.pixels,
                weights=self._weights,
                color_out=self._color_sums,
                area_out=self._area_sums,
            )
        return record_edge_moments(
            self.device,
            self.layout,
            vertices=vertices,
            edges=self._edges,
            moved=self._freedom.marks,
            probe=self._probe,
            table=self.table,
            size=self.size,
            color_out=self._color_sums,
            area_out=self._area_sums,
        )

    def _resize(self) -> None:
        """Set the size of every launch to the mesh in place."""
        vertices, triangles, edges = self._counts
        for phase in self._moments:
            phase.resize(edges if self.sums == "edges" else triangles)
        for phase in self._fit_sums:
            phase.resize(edges)
        for phase in (self._energy, self._fit):
            phase.resize(triangles)
        for phase in self._descents:
            phase.resize(vertices)

    def _empty(self, shape: Any, dtype: Any) -> wp.array:
        return self.device.empty(shape, dtype)
