"""What all experiments share: pictures, a device, solved triangulations, a place for plots."""

from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from time import perf_counter

import numpy as np

from benchmarks.paper.methods import Method
from benchmarks.paper.trace import Moment, watched_iterations
from stages.frame import Frame
from stages.layouts import LAYOUTS, Layout
from stages.mesh import Mesh
from stages.optimize import load_mesh
from stages.snapshot import Snapshot
from stages.triangulate import Triangulator
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device
from warp_kernels.energy.workspace import Workspace

TIME_BASE = Fraction(1, 25)


@dataclass(frozen=True, eq=False)
class Solution:
    """A triangulated picture."""

    snapshot: Snapshot
    """The mesh and its colours."""
    seconds: float
    """From the decoded picture to the fitted colours [s]."""
    moments: tuple[Moment, ...] = ()
    """How it came about, if that was watched."""

    @property
    def rmse(self) -> float:
        """Root mean square error over pixels and channels [code values]."""
        return self.snapshot.rmse

    @property
    def triangles(self) -> int:
        """Number of triangles."""
        return self.snapshot.mesh.triangle_count


@dataclass(frozen=True, eq=False)
class Study:
    """One run of experiments over a set of pictures."""

    pictures: dict[str, np.ndarray]
    """By name, [H, W, 3] uint8."""
    device: Device
    """Where kernels run."""
    plots: Path
    """Folder of the plots."""
    counts: tuple[int, ...] = (300, 700, 1500)
    """Numbers of triangles of the comparisons."""
    seed: int = 0
    """Of all randomness."""
    iterations: int | None = None
    """Of every method instead of its own, to try things out quickly."""
    say: Callable[[str], None] = print
    """Tells the progress."""
    _solved: dict[tuple, Solution] = field(default_factory=dict)
    _workspaces: dict[tuple, Workspace] = field(default_factory=dict)

    @property
    def first(self) -> str:
        """Name of the picture that stands for all where one must do."""
        return next(iter(self.pictures))

    def rng(self) -> np.random.Generator:
        """The generator with which every layout begins."""
        return np.random.default_rng([self.seed, 0])

    def solve(self, name: str, method: Method, count: int) -> Solution:
        """Triangulate a picture once for all experiments, timed.

        Args:
            name: The picture.
            method: How.
            count: Wanted number of triangles.
        """
        key = (name, method, count)
        if key not in self._solved:
            if not any(done[1] == method for done in self._solved):
                # compilation is no part of the time
                self.triangulate(name, method.with_options(iterations=20), 50)
            self._solved[key] = self.triangulate(name, method, count)
        return self._solved[key]

    def triangulate(
        self,
        name: str,
        method: Method,
        count: int,
        *,
        error: float | None = None,
        layout: Layout | None = None,
        rng: np.random.Generator | None = None,
    ) -> Solution:
        """Triangulate a picture.

        Args:
            name: The picture.
            method: How.
            count: Wanted number of triangles.
            error: Threshold of the refinement [code values], if the number is only a cap.
            layout: The first mesh, if not the method's.
            rng: Randomness of the layout, if not the study's.
        """
        pixels = self.pictures[name]
        frame = Frame(0, 0, TIME_BASE, pixels)
        if self.iterations is not None:
            method = method.with_options(iterations=min(self.iterations, method.options.iterations))
        options = method.with_triangles(count, error)
        triangulator = Triangulator(self.device, (frame.width, frame.height), options)
        begun = perf_counter()
        snapshot = triangulator.first(frame, layout or LAYOUTS[method.layout](), rng or self.rng())
        return Solution(snapshot, perf_counter() - begun)

    def watch(self, name: str, method: Method, count: int, **named: object) -> Solution:
        """As `triangulate`, with the moments on the way; the time includes the watching."""
        with watched_iterations() as moments:
            solution = self.triangulate(name, method, count, **named)
        end = Moment(moments[-1].iterations, solution.triangles, solution.rmse)
        return Solution(solution.snapshot, solution.seconds, (*moments[:-1], end))

    def fit(self, name: str, mesh: Mesh, color: str) -> Snapshot:
        """Give a mesh the best colours, as it is.

        Args:
            name: The picture.
            mesh: The mesh.
            color: Member of `COLOR_MODELS`.
        """
        workspace = self.workspace(name, color)
        load_mesh(workspace, mesh)
        coefficients, energies, counts = workspace.fit()
        return Snapshot(
            frame_index=0,
            pts=0,
            time_base=TIME_BASE,
            mesh=mesh,
            model=workspace.model,
            coefficients=coefficients,
            energies=energies,
            counts=counts,
        )

    def workspace(self, name: str, color: str) -> Workspace:
        """A workspace that holds a picture."""
        if (name, color) not in self._workspaces:
            pixels = self.pictures[name]
            size = (pixels.shape[1], pixels.shape[0])
            workspace = Workspace(self.device, size, COLOR_MODELS[color])
            workspace.load_image(pixels)
            self._workspaces[name, color] = workspace
        return self._workspaces[name, color]
