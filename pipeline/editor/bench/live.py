"""The optimiser at work, one step at a time: a preview that leaves no trace."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from pipeline.options.solve_options import SolveOptions
from stages.frame import Frame
from stages.hand import Edit
from stages.hand.worked import Worked
from stages.mesh import Mesh
from stages.motion.painted_focus import NOTHING_PAINTED
from stages.motion.springs import LOCK
from stages.optimize import load_mesh, optimize
from stages.optimize_options import OptimizeOptions
from stages.spaces import SPACES
from stages.topology import TOPOLOGIES
from stages.topology.appraise import Appraiser
from stages.topology.goal import SLIVER_HEIGHT, Goal
from stages.topology.refine_options import RefineOptions
from warp_kernels.color_model import CHANNELS
from warp_kernels.device.device import Device
from warp_kernels.energy.workspace import Workspace

ROUND = 6
"""Steps between two looks at the topology."""
NEARER = 0.2
"""Part of the way to the wanted number of triangles that one look goes: it shall be seen."""


@dataclass(frozen=True)
class Descent:
    """What the optimiser aims at.

    Raises:
        OptionError: If a value is impossible.
    """

    refine: RefineOptions
    """How many triangles, and where."""
    optimize: OptimizeOptions
    """How vertices move."""

    @classmethod
    def of(cls, options: SolveOptions, given: Mapping[str, float]) -> "Descent":
        """The course of a solution, but for what a window has chosen.

        Args:
            options: How the clip was solved.
            given: `triangles`, `error` [code values], `regularity` and `trust_region` [px], as
                far as they are chosen; an error of 0 is none.
        """
        refine, way = options.triangulate.refine, options.triangulate.optimize
        if "triangles" in given:
            refine = replace(refine, triangles=int(given["triangles"]), quality=None)
        if given.get("error"):
            refine = replace(refine, error=float(given["error"]), quality=None)
        chosen = {key: given[key] for key in ("regularity", "trust_region") if key in given}
        return cls(refine, replace(way, **chosen))


class Live:
    """Optimises the mesh of one frame; used by one thread.

    Args:
        device: Where kernels run.
        options: How the clip was solved.
        frame: The picture.
        worked: The mesh, and what of it is held.
    """

    def __init__(self, device: Device, options: SolveOptions, frame: Frame, worked: Worked) -> None:
        self._device, self._solving = device.beside(), options.triangulate
        self._space = SPACES[self._solving.space]()
        self._topology = TOPOLOGIES[self._solving.topology]()
        self.frame, self.worked, self.steps = frame, worked, 0
        self._plain = self._bench(replace(frame, weights=None))
        self._seeing = self._plain  # with what a person painted that errors count more
        self._hold(worked)

    def step(self, course: Descent) -> None:
        """One step of every vertex; now and then triangles come and go.

        Args:
            course: What is aimed at.
        """
        mesh = self.worked.mesh
        scale = self._space.scale
        way = replace(course.optimize, regularity=course.optimize.regularity * scale)
        workspace, appraiser = self._seeing
        load_mesh(workspace, mesh, self._springs(mesh))
        mesh = optimize(workspace, mesh, 1, way)
        self.steps += 1
        if self.steps % ROUND == 0:
            mesh = self._topology.adapt(mesh, appraiser, self._goal(mesh, course.refine))
        self.worked = self.worked.became(mesh)

    def make(self, edits: Iterable[Edit]) -> None:
        """Make edits of the mesh as it is now; it is optimised on from there.

        Args:
            edits: Edits of the frame.

        Raises:
            EditError: If one cannot be made; then none is.
        """
        worked = self.worked
        for edit in edits:
            worked = edit.apply(worked)
        self._hold(worked)

    @property
    def energies(self) -> np.ndarray:
        """E(T) of the space of the error [code value^2 px], [T]; all pixels count alike in it."""
        return self._plain[1].energies(self.worked.mesh)

    @property
    def colors(self) -> np.ndarray:
        """Colours at the centres of the triangles, of the space of the error, [T, 3]."""
        _, appraiser = self._plain
        appraiser.energies(self.worked.mesh)
        return appraiser.colors

    @property
    def rmse(self) -> float:
        """Root mean square error [code values of the space]."""
        mesh = self.worked.mesh
        return float(np.sqrt(2.0 * self.energies.sum() / (CHANNELS * mesh.width * mesh.height)))

    def _bench(self, frame: Frame) -> tuple[Workspace, Appraiser]:
        """What a picture, with its weights if it has any, is worked on with."""
        solving, is_weighted = self._solving, frame.weights is not None
        size = frame.width, frame.height
        workspace = Workspace(self._device, size, solving.model, solving.sums, is_weighted)
        workspace.load_image(self._space.convert(frame.pixels), frame.weights)
        return workspace, Appraiser(workspace, SLIVER_HEIGHT)

    def _hold(self, worked: Worked) -> None:
        """Go on with a mesh: with what is held of it, and where errors count more in it."""
        is_known = self._seeing is not self._plain and self.worked.focus == worked.focus
        if worked.focus and not is_known:
            plain = replace(self.frame, weights=None)
            frame = NOTHING_PAINTED.weighed(plain, worked.mesh, worked.focus)
            self._seeing = self._plain if frame.weights is None else self._bench(frame)
        self.worked = worked
        for _, appraiser in (self._plain, self._seeing):
            appraiser.hold(worked.locks)

    def _springs(self, mesh: Mesh) -> np.ndarray:
        """What holds vertices fast that a person holds, [V, 4]."""
        held = np.isin(mesh.vertex_ids, self.worked.locks.vertices)
        return np.column_stack([mesh.vertices, np.where(held, LOCK, 0.0), np.zeros(len(held))])

    def _goal(self, mesh: Mesh, refine: RefineOptions) -> Goal:
        """A part of the way to the wanted number."""
        wanted = refine.triangles + self.worked.locks.extra(mesh)
        missing = wanted - mesh.triangle_count
        count = mesh.triangle_count + int(np.sign(missing) * np.ceil(NEARER * abs(missing)))
        return Goal(count, refine.error, largest_area=refine.largest_area or inf)
