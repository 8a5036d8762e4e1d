"""One frame, from a seed mesh to a snapshot: the only file that orders the steps."""

from dataclasses import dataclass, field

import numpy as np

from stages.appraise import Appraiser
from stages.frame import Frame
from stages.layouts import Layout
from stages.mesh import Mesh
from stages.optimize import OptimizeOptions, load_mesh, optimize
from stages.refine import RefineOptions
from stages.snapshot import Snapshot
from stages.topology import TOPOLOGIES, Goal
from stages.topology.goal import SLIVER_HEIGHT
from warp_kernels.color_model import COLOR_MODELS, ColorModel
from warp_kernels.device import Device
from warp_kernels.errors import OptionError
from warp_kernels.solve import SUMS
from warp_kernels.workspace import Workspace

LAYOUT_SHARE = 0.5
"""Part of the wanted triangles that the layout places; refinement places the rest."""
FEW = 64
"""Triangles of the layout where a threshold decides how many there will be."""
REFINING_SHARE = 0.85
"""Part of a first frame's iterations during which the topology changes (the paper: 400 of 600)."""
GROWING_SHARE = 0.6
"""Part of those after which the number of triangles is reached."""
ROUND = 8
"""Iterations between two looks at the topology of a first frame."""
LAST_TRUST = 0.1
"""Trust region of the last iteration beside the first one's: it shrinks so that vertices settle."""
SPRING = 1500.0
"""Strength of the temporal term [code value^2]: a vertex leaves the flow's path where the picture
pulls harder than noise does."""
DEAD_BAND = 0.1
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
        default=240, metadata={"help": "optimiser iterations for the first frame of a shot"}
    )
    frame_iterations: int = field(
        default=8, metadata={"help": "optimiser iterations for each later frame"}
    )
    topology: str = field(
        default="energy",
        metadata={
            "help": "flips that lower the energy, or the paper's Delaunay flips",
            "choices": tuple(TOPOLOGIES),
        },
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
        self._topology = TOPOLOGIES[options.topology]()
        self._appraiser = Appraiser(self._workspace, SLIVER_HEIGHT)
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
        self._load(frame)
        mesh = layout.build(frame.pixels, self._layout_count, rng)
        return self._snapshot(frame, self._settle(self._refine(mesh)))

    def _load(self, frame: Frame) -> None:
        self._workspace.load_image(frame.pixels)
        self._appraiser.forget()

    def next(self, frame: Frame, seed: Mesh) -> Snapshot:
        """Triangulate a frame that continues a shot.

        Args:
            frame: The frame.
            seed: The previous frame's mesh, carried along by the flow.
        """
        options = self.options
        self._load(frame)
        mesh = self._follow(seed, seed, options.frame_iterations // 2)
        goal = Goal(options.refine.triangles, options.refine.error, calm=True)
        mesh = self._topology.adapt(mesh, self._appraiser, goal)
        mesh = self._follow(mesh, seed, options.frame_iterations - options.frame_iterations // 2)
        return self._snapshot(frame, mesh)

    def fit(self, frame: Frame, mesh: Mesh) -> Snapshot:
        """Fit the colours alone, to a mesh that stays as it is.

        Args:
            frame: The frame.
            mesh: What it became before.
        """
        self._load(frame)
        load_mesh(self._workspace, mesh)
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

    @property
    def _layout_count(self) -> int:
        """Triangles of the first mesh: a part of the wanted number, or few for a threshold."""
        refine = self.options.refine
        count = FEW if refine.error is not None else round(LAYOUT_SHARE * refine.triangles)
        return max(2, min(count, refine.triangles))

    def _refine(self, mesh: Mesh) -> Mesh:
        """Alternate optimisation and changes of topology until the wanted number is reached."""
        options = self.options
        rounds = max(1, int(options.iterations * REFINING_SHARE) // ROUND)
        goal, start = options.refine.triangles, mesh.triangle_count
        for number in range(1, rounds + 1):
            load_mesh(self._workspace, mesh)
            mesh = optimize(self._workspace, mesh, ROUND, options.optimize)
            grown = round(start * (goal / start) ** min(1.0, number / (GROWING_SHARE * rounds)))
            target = Goal(min(grown, goal), options.refine.error)
            mesh = self._topology.adapt(mesh, self._appraiser, target)
        return mesh

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
        """Fit the colours to the mesh that lies in the workspace, just optimised."""
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
