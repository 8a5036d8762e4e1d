"""One frame, from a seed mesh to a snapshot: the only file that orders the steps."""

from dataclasses import dataclass, field

import numpy as np

from stages.collapse import collapse_slivers
from stages.edits import legalise
from stages.frame import Frame
from stages.layouts import Layout
from stages.mesh import Mesh
from stages.optimize import OptimizeOptions, load_mesh, optimize
from stages.refine import RefineOptions, refine
from stages.snapshot import Snapshot
from warp_kernels.color_model import COLOR_MODELS, ColorModel
from warp_kernels.device import Device
from warp_kernels.errors import OptionError
from warp_kernels.solve import SUMS
from warp_kernels.workspace import Workspace

TOPOLOGIES = ("delaunay",)
"""How edges are kept: by flips that restore the Delaunay property while the mesh refines."""

LAYOUT_SHARE = 0.5
"""Part of the wanted triangles that the layout places; refinement places the rest."""
REFINING_SHARE = 0.66
"""Part of a first frame's iterations after which the number of triangles is reached (the paper
refines during 400 of 600)."""
ROUND = 10
"""Iterations between two looks at the topology of a first frame."""
LAST_TRUST = 0.1
"""Trust region of the last iteration beside the first one's: it shrinks so that vertices settle."""
SLIVER_HEIGHT = 0.5
"""Triangles thinner than this collapse [px]: hardly a pixel's centre lies in them."""
SPRING = 1500.0
"""Strength of the temporal term [code value^2]: a vertex leaves the flow's path where the picture
pulls harder than noise does."""
DEAD_BAND = 0.02
"""Steps of later frames below this are not taken [px]: noise must not move what stands still."""


@dataclass(frozen=True)
class TriangulateOptions:
    """How one picture becomes triangles.

    Raises:
        OptionError: If an option has an impossible value.
    """

    color: str = field(
        default="constant",
        metadata={"help": "colour model that is optimised", "choices": tuple(COLOR_MODELS)},
    )
    iterations: int = field(
        default=600, metadata={"help": "optimiser iterations for the first frame of a shot"}
    )
    frame_iterations: int = field(
        default=20, metadata={"help": "optimiser iterations for each later frame"}
    )
    topology: str = field(
        default="delaunay",
        metadata={"help": "how edges are kept while the mesh refines", "choices": TOPOLOGIES},
    )
    sums: str = field(
        default="edges",
        metadata={"help": "how moments are summed; equal results", "choices": SUMS},
    )
    optimize: OptimizeOptions = field(default_factory=OptimizeOptions)
    refine: RefineOptions = field(default_factory=RefineOptions)

    def __post_init__(self) -> None:
        for name in ("iterations", "frame_iterations"):
            if getattr(self, name) < 0:
                flag = name.replace("_", "-")
                raise OptionError(f"--{flag} {getattr(self, name)}: must be 0 or more")
        for name, known in (("color", COLOR_MODELS), ("topology", TOPOLOGIES), ("sums", SUMS)):
            if getattr(self, name) not in known:
                raise OptionError(
                    f"--{name} {getattr(self, name)}: unknown; choose from {', '.join(known)}"
                )

    @property
    def model(self) -> ColorModel:
        """The colour model that is optimised."""
        return COLOR_MODELS[self.color]


class Triangulator:
    """Turns frames of one size into snapshots; owns the device memory for it.

    Args:
        device: Where kernels run.
        size: Width and height of the frames [px].
        options: How a picture becomes triangles.
        drawn: The colour model that will be drawn; the snapshots' colours fit it if it has more
            terms than the optimised one.

    Raises:
        OptionError: If the frames are too large.
    """

    def __init__(
        self,
        device: Device,
        size: tuple[int, int],
        options: TriangulateOptions,
        drawn: ColorModel | None = None,
    ) -> None:
        self.options = options
        self._workspace = Workspace(device, size, options.model, options.sums)
        self._fitting = self._workspace
        if drawn is not None and drawn.degree > options.model.degree:
            self._fitting = Workspace(device, size, drawn)

    def first(self, frame: Frame, layout: Layout, rng: np.random.Generator) -> Snapshot:
        """Triangulate a frame from scratch.

        Args:
            frame: The frame.
            layout: Makes the first mesh.
            rng: Randomness of the layout.
        """
        options = self.options
        self._workspace.load_image(frame.pixels)
        threshold = options.refine.error
        start = options.refine.triangles if threshold is None else 64
        mesh = layout.build(frame.pixels, max(2, round(LAYOUT_SHARE * start)), rng)
        mesh = self._refine_from(mesh)
        mesh = self._settle(mesh)
        return self._snapshot(frame, mesh)

    def next(self, frame: Frame, seed: Mesh) -> Snapshot:
        """Triangulate a frame that continues a shot.

        Args:
            frame: The frame.
            seed: The previous frame's mesh, carried along by the flow.
        """
        options = self.options
        self._workspace.load_image(frame.pixels)
        mesh = self._follow(seed, seed, options.frame_iterations // 2)
        mesh = self._refined(mesh, options.refine.triangles, everywhere=False)
        mesh = self._follow(mesh, seed, options.frame_iterations - options.frame_iterations // 2)
        return self._snapshot(frame, mesh)

    def _follow(self, mesh: Mesh, seed: Mesh, iterations: int) -> Mesh:
        """Optimise, with every vertex on a spring to where the flow took it."""
        springs = np.zeros((mesh.vertex_count, 3))
        springs[:, :2] = mesh.vertices
        old = np.searchsorted(seed.vertex_ids, mesh.vertex_ids)
        known = mesh.vertex_ids < seed.next_vertex_id
        springs[known, :2] = seed.vertices[old[known]]
        springs[known, 2] = SPRING
        load_mesh(self._workspace, mesh, springs)
        return optimize(
            self._workspace, mesh, iterations, self.options.optimize, dead_band=DEAD_BAND
        )

    def _refine_from(self, mesh: Mesh) -> Mesh:
        """Alternate optimisation and refinement until the wanted number is reached."""
        options = self.options
        rounds = max(1, int(options.iterations * REFINING_SHARE) // ROUND)
        goal, start = options.refine.triangles, mesh.triangle_count
        for number in range(1, rounds + 1):
            load_mesh(self._workspace, mesh)
            mesh = optimize(self._workspace, mesh, ROUND, options.optimize)
            grown = round(start * (goal / start) ** (number / rounds))
            mesh = self._refined(mesh, min(grown, goal))
        return mesh

    def _refined(self, mesh: Mesh, count: int, *, everywhere: bool = True) -> Mesh:
        """Drop slivers, split the worst triangles up to `count`, restore Delaunay there."""
        before = mesh.next_triangle_id
        mesh = collapse_slivers(mesh, SLIVER_HEIGHT)
        load_mesh(self._workspace, mesh)
        _, energies, _ = self._workspace.fit()
        mesh = refine(mesh, energies, count=count, threshold=self.options.refine.error)
        return legalise(mesh, None if everywhere else mesh.triangle_ids >= before)

    def _settle(self, mesh: Mesh) -> Mesh:
        """The last iterations: no change of topology, smaller and smaller steps.

        Source: Lawonn & Guenther (2018), Sec. 6.6 (no Delaunay at the end), Sec. 3.2 (trust region
            that decreases over time).
        """
        options = self.options
        left = options.iterations - int(options.iterations * REFINING_SHARE) // ROUND * ROUND
        load_mesh(self._workspace, mesh)
        for begin in range(0, left, ROUND):
            trust = options.optimize.trust_region * LAST_TRUST ** (begin / left)
            steps = min(ROUND, left - begin)
            mesh = optimize(self._workspace, mesh, steps, options.optimize, trust_region=trust)
        return mesh

    def _snapshot(self, frame: Frame, mesh: Mesh) -> Snapshot:
        fitting = self._fitting
        if fitting is not self._workspace:
            fitting.load_image(frame.pixels)
        load_mesh(fitting, mesh)
        coefficients, energies, counts = fitting.fit()
        return Snapshot(
            frame_index=frame.index,
            pts=frame.pts,
            time_base=frame.time_base,
            mesh=mesh,
            model=fitting.model,
            coefficients=coefficients,
            energies=energies,
            counts=counts,
        )
