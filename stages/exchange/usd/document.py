"""The file of a USD stage: `.usdc` binary, `.usda` text, `.usd` binary."""

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import ClassVar

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format
from stages.exchange.solids.corners import HELD, corner_colors, refuse_stacks, vertex_places
from stages.exchange.solids.linear_light import linear_light
from stages.exchange.solids.runs import MeshPose, MeshRun, MeshRuns
from stages.exchange.usd.library import require_usd

SNAP = Fraction(1, 8)
"""Times this near to a whole time code are put there [frames]: files round them to milliseconds."""


class Usd(Format):
    """A mesh for every run of unchanged topology, visible in its time, or one mesh for all.

    Source: Pixar, OpenUSD: UsdGeom's schemas Mesh, Imageable, PrimvarsAPI and Camera.
    """

    styles: ClassVar[tuple[str, ...]] = HELD
    most_degree: ClassVar[int] = 1

    def __init__(self, film: Film) -> None:
        super().__init__(film)
        self._runs = MeshRuns(most_poses=None)

    @classmethod
    def check(cls, film: Film) -> None:
        """As every format, one style only, and the library is there."""
        super().check(film)
        refuse_stacks(film)
        require_usd(film.ending)

    def add(self, figure: Figure) -> None:
        """Take a frame."""
        mesh, is_flat = figure.mesh, self.film.styles[-1].degree == 0
        points = vertex_places(figure, self.film)
        if is_flat:
            codes = figure.colors
        else:
            codes = corner_colors(figure, self.film)[:, [0, 2, 1]].reshape(-1, 3)
        pose = MeshPose(figure.index, figure.time, points, linear_light(codes))
        self._runs.add(figure, mesh.triangles[:, [0, 2, 1]], pose)

    def save(self, path: Path) -> None:
        """Write them.

        Raises:
            OSError: If the library cannot.
        """
        from stages.exchange.usd.meshes import add_one_mesh, add_runs
        from stages.exchange.usd.scene import saved_scene

        runs = self._runs.found
        times = self._time_codes(runs)
        add: Callable[..., None] = add_one_mesh if self.film.options.usd_single else add_runs
        is_flat = self.film.styles[-1].degree == 0
        saved_scene(path, self.film, times, lambda parent: add(parent, runs, times, is_flat))

    def _time_codes(self, runs: list[MeshRun]) -> list[float] | None:
        """When each frame is shown [frames of the source]; None for a still."""
        poses = [pose for run in runs for pose in run.poses]
        if len(poses) == 1:
            return None
        rate = self.film.rate or Fraction(25)
        exact = [pose.time * rate for pose in poses]
        whole = [Fraction(round(code)) for code in exact]
        near = all(abs(a - b) <= SNAP for a, b in zip(exact, whole, strict=True))
        if near and (np.diff(np.array(whole, np.float64)) > 0).all():
            exact = whole
        return [float(code) for code in exact]
