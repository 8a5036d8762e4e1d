"""One frame, from a seed mesh to a snapshot: the only file that orders the steps."""

from dataclasses import replace

import numpy as np

from stages.frame import Frame
from stages.hand.locks import NO_LOCKS, Locks
from stages.layouts import Layout
from stages.mesh import Mesh
from stages.motion.advect import Carried
from stages.motion.boiling import Unrest
from stages.motion.friction import friction_of
from stages.snapshot import Snapshot
from stages.solve.approximate import Approximator
from stages.solve.bench import Bench
from stages.solve.fitting import Fitting
from stages.solve.following import Following
from stages.solve.grid import rounded_places
from stages.solve.hold import Hold
from stages.solve.quality import FALL, Trial, smallest_that_reaches
from stages.solve.rhythm import BOILING, CALM
from stages.spaces import SPACES
from stages.topology import TOPOLOGIES
from stages.topology.appraise import Appraiser
from stages.topology.goal import SLIVER_HEIGHT, Goal
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions
from warp_kernels.color_model import CHANNELS, ColorModel
from warp_kernels.device.device import Device
from warp_kernels.energy.solver_kernels import limiting_kernels, solving_kernels
from warp_kernels.energy.workspace import Workspace

SPRING = 30.0
"""Strength of the temporal term where the motion is certain, as a multiple of the mean squared
error of the mesh: what pulls at vertices without cause grows with what triangles cannot show."""
RENEWED = 0.8
"""Where a later frame boils it is refined anew over this share of its rounds."""
CALM_QUALITY = 0.02
"""A later frame keeps its number of triangles while its rmse is this close to the wanted one."""
MOST_DRIFT = 0.02
"""Most that the number of triangles changes from one frame to the next, as a part of it."""


class Triangulator:
    """Turns frames of one size into snapshots; owns the device memory for it.

    Args:
        device: Where kernels run.
        size: Width and height of the frames [px].
        options: How a picture becomes triangles.
        drawn: The colour model that will be drawn; the snapshots' colours fit it if it has more
            terms than the optimised one. They are fitted in RGB whatever the space of the error.

    Frames without weights and frames with them may follow each other: the memory for weights is
    taken with the first frame that has some. Weights decide where triangles go; colours are means
    of all pixels alike, and so are the energies of snapshots.

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
        self._space = SPACES[options.space]()
        self._options = _against(options, self._space.scale)
        self._device, self._size = device, size
        self._hold = Hold(options.keep_layout)
        self._least = options.refine.least_count(*size)
        fitted = max(options.model, drawn or options.model, key=lambda model: model.degree)
        device.expect(limiting_kernels(device, options.model, fitted))
        self._even = self._bench(weighted=False)
        self._weighted: Bench | None = None
        self._locks = NO_LOCKS
        self._in_use = self._even
        self._solved: Snapshot | None = None  # with energies by the colours that are optimised
        of_error = self._even.workspace if options.space == "rgb" else None
        self._own = Fitting(of_error or Workspace(device, size, options.model))
        """Colours of the optimised model: what decides on meshes must not hang on what is drawn."""
        is_own = fitted is options.model
        self._drawn = self._own if is_own else Fitting(Workspace(device, size, fitted))

    def _bench(self, *, weighted: bool) -> Bench:
        """Make what pictures with weights, or those without, are worked on with."""
        options = self._options
        self._device.expect(solving_kernels(self._device, options.model, options.sums, weighted))
        workspace = Workspace(self._device, self._size, options.model, options.sums, weighted)
        appraiser = Appraiser(workspace, SLIVER_HEIGHT)
        approximator = Approximator(
            workspace=workspace,
            topology=self._hold.calmed(TOPOLOGIES[options.topology]()),
            appraiser=appraiser,
            options=options.optimize,
            iterations=options.iterations,
            hold=self._hold,
        )
        return Bench(workspace, appraiser, approximator)

    def _lock(self, locks: Locks) -> None:
        """Hold fast from now on what a person holds, and nothing else."""
        if self._locks is not locks:
            self._locks = locks
            for bench in (self._even, self._weighted):
                if bench is not None:
                    bench.appraiser.hold(locks)

    def refine_by(self, refine: RefineOptions) -> None:
        """Have other numbers of triangles, or bounds of the error, from the next frame on.

        Args:
            refine: How many, and where; all else stays as the options said.
        """
        self._options = replace(self._options, refine=refine)

    def first(self, frame: Frame, layout: Layout, rng: np.random.Generator) -> Snapshot:
        """Triangulate a frame from scratch.

        Args:
            frame: The frame.
            layout: Makes the first mesh.
            rng: Randomness of the layout.
        """
        self._lock(NO_LOCKS)
        self._load(frame)
        refine = self._options.refine

        def attempt(count: int) -> Trial:
            """Approximate the frame."""
            return self._trial(frame, layout, rng, self._goal(count))

        def torn(mesh: Mesh) -> np.ndarray:
            """The triangles that no one colour becomes."""
            return self._own.torn(frame, mesh)

        if refine.quality is None:
            mesh = attempt(refine.triangles).mesh
            goal = self._goal(mesh.triangle_count)
            return self._solution(frame, self._in_use.approximator.mended(mesh, torn, goal))
        pixels = frame.width * frame.height
        mesh = smallest_that_reaches(refine.quality, attempt, least=self._least, pixels=pixels)
        return self._solution(frame, mesh)

    def _load(self, frame: Frame) -> None:
        """Take in a picture: as it is, and with its weights if it has any."""
        pixels = self._space.convert(frame.pixels)
        self._even.load(pixels)
        bench = self._even
        if frame.weights is not None:
            if self._weighted is None:
                self._weighted = self._bench(weighted=True)
                self._weighted.appraiser.hold(self._locks)
            bench = self._weighted
            bench.load(pixels, frame.weights)
        self._in_use = bench
        self._load_for_colors(frame)

    def _load_for_colors(self, frame: Frame) -> None:
        """Take in a picture in RGB wherever colours are fitted but nothing is optimised."""
        for workspace in {self._own.workspace, self._drawn.workspace} - {self._even.workspace}:
            workspace.load_image(frame.pixels)

    def next(
        self,
        frame: Frame,
        seed: Carried,
        earlier: Snapshot | None = None,
        *,
        renewed: bool = False,
    ) -> Snapshot:
        """Triangulate a frame that continues a shot.

        Args:
            frame: The frame.
            seed: The previous frame's mesh, carried along by the motion.
            earlier: What was given for the previous frame, here or to `recall`: by it is told where
                the picture boils, and colours keep to its; None for neither.
            renewed: Whether all that is not held is refined anew, for other errors count now.
        """
        self._lock(seed.locks)
        self._load(frame)
        error = self._rmse(seed.mesh) ** 2
        unrest = Unrest.everywhere(seed.mesh) if renewed else self._unrest(seed, earlier)
        unrest = None if self._hold.share else unrest
        seed = self._slowed(frame, seed, earlier) if unrest is None else unrest.freed(seed)
        rhythm = CALM if unrest is None else BOILING
        rounds, each = rhythm.spread(0 if self._hold.is_full else self._options.frame_iterations)
        following = Following(
            bench=self._in_use,
            options=self._options.optimize,
            seed=seed,
            energies=self._in_use.appraiser.energies(seed.mesh),
            spring=SPRING * error,
            hold=self._hold.strength(error),
            weights=frame.weights,
            iterations=each,
        )
        mesh = following.moved(seed.mesh)
        if unrest is not None:
            renewing = int(RENEWED * rounds)
            mesh = self._renew(mesh, following, unrest, renewing)
            rounds -= renewing
        count = self._followed_count(mesh)
        if self._hold.is_full and earlier is not None:
            count = earlier.mesh.triangle_count  # a layout has about as many as were asked for
        goal = self._goal(count, calm=True, unrest=unrest)
        mesh = following.settled(mesh, goal, rounds, rhythm.watch())
        mesh = self._in_use.approximator.within_limits(mesh, goal)
        return self._solution(frame, mesh, earlier, unrest)

    def _renew(self, mesh: Mesh, following: Following, unrest: Unrest, rounds: int) -> Mesh:
        """Refine a mesh anew where it boils, and adapt it elsewhere as always.

        Args:
            mesh: What has become of the seed.
            following: Moves its vertices.
            unrest: Where it boils.
            rounds: Looks at the topology.
        """
        refine = self._options.refine
        count = mesh.triangle_count
        if refine.quality is None:
            count = refine.triangles + self._locks.extra(mesh)
        boiling = int(unrest.boiling(mesh).sum())
        renewal = self._in_use.approximator.topology.renewal
        for number in range(1, rounds + 1):
            unrest = unrest.passed_on(mesh)
            more = renewal.count(number / rounds, boiling) - boiling
            goal = self._goal(count + more, calm=True, unrest=unrest)
            mesh = following.moved(following.adapted(mesh, goal))
        return mesh

    def fit(self, frame: Frame, mesh: Mesh) -> Snapshot:
        """Fit the colours alone, to a mesh that stays as it is.

        Args:
            frame: The frame.
            mesh: What it became before.
        """
        workspace = self._drawn.workspace
        if workspace is self._even.workspace:
            self._even.load(frame.pixels)
        else:
            workspace.load_image(frame.pixels)
        return self._drawn.snapshot(frame, mesh, locks=self._locks)

    def recall(self, frame: Frame, snapshot: Snapshot) -> None:
        """Take up a solution that another run began; `next` goes on from there.

        Args:
            frame: The last frame that was solved.
            snapshot: What it became.
        """
        self._even.load(self._space.convert(frame.pixels))
        self._solved = replace(snapshot, energies=self._even.appraiser.energies(snapshot.mesh))

    def _unrest(self, seed: Carried, earlier: Snapshot | None) -> Unrest | None:
        """Where the picture boils, told by the colours that are optimised, not those drawn."""
        if earlier is not None and self._solved is not None and self._solved.mesh is earlier.mesh:
            return Unrest.between(self._solved, seed, self._even.appraiser.energies(seed.mesh))
        return None

    def _slowed(self, frame: Frame, seed: Carried, earlier: Snapshot | None) -> Carried:
        """A mesh as it came along, with friction where the picture stays as it was."""
        solved = self._solved
        if earlier is None or solved is None or solved.mesh is not earlier.mesh:
            return seed
        energies = self._even.appraiser.energies(seed.mesh)
        friction = friction_of(solved.mesh, solved.energies, seed.mesh, energies, frame.index)
        return replace(seed, friction=friction)

    def _followed_count(self, mesh: Mesh) -> int:
        """How many triangles a later frame shall have; a quality lets their number drift.

        What is held fast comes on top.
        """
        refine = self._options.refine
        if refine.quality is None:
            return refine.triangles + self._locks.extra(mesh)
        missed = self._rmse(mesh) / refine.quality
        if abs(missed - 1) < CALM_QUALITY:
            return mesh.triangle_count
        drift = min(max(missed ** (1 / FALL), 1 - MOST_DRIFT), 1 + MOST_DRIFT)
        return max(self._least, round(mesh.triangle_count * drift))

    def _trial(self, frame: Frame, layout: Layout, rng: np.random.Generator, goal: Goal) -> Trial:
        """Approximate the picture in the workspace from scratch."""
        count = self._in_use.approximator.growth(goal).count(0.0, goal.count)
        if self._in_use.approximator.keeps_layout:
            count = goal.count
        mesh = layout.build(frame.pixels, max(2, count), rng)
        mesh = self._in_use.approximator.approximate(mesh, goal)
        is_rgb = self._own.workspace is self._even.workspace
        if self._options.refine.quality is None or not is_rgb:
            return Trial(mesh, self._rmse(mesh))
        return Trial(mesh, self._own.snapshot(frame, mesh).rmse)  # moved colours cost a little

    def _rmse(self, mesh: Mesh) -> float:
        """Root mean square error per channel, of all pixels alike [code values of the space]."""
        samples = CHANNELS * mesh.width * mesh.height
        return float(np.sqrt(2.0 * self._even.appraiser.energies(mesh).sum() / samples))

    def _goal(self, count: int, *, calm: bool = False, unrest: Unrest | None = None) -> Goal:
        """What the mesh must be like, with a number of triangles."""
        refine = self._options.refine
        return Goal(count, refine.error, calm, refine.largest_area, unrest)

    def _solution(
        self,
        frame: Frame,
        mesh: Mesh,
        earlier: Snapshot | None = None,
        unrest: Unrest | None = None,
    ) -> Snapshot:
        """The snapshot of a mesh that was just optimised, and that the next frame starts from."""
        mesh = rounded_places(mesh)
        calm = None if unrest is None else unrest.calm(mesh)
        snapshot = self._drawn.snapshot(frame, mesh, earlier, self._locks, calm)
        self._solved = replace(snapshot, energies=self._even.appraiser.energies(mesh))
        return snapshot


def _against(options: TriangulateOptions, scale: float) -> TriangulateOptions:
    """Options that weigh against energies of another scale what they say for those of RGB.

    Args:
        options: As the user gave them; `error` is in code values of the space already.
        scale: Energy of an error over its energy in RGB, typically [1].
    """
    regularity = options.optimize.regularity * scale
    return replace(options, optimize=replace(options.optimize, regularity=regularity))
