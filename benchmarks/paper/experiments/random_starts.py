"""Fig. 9: ten random first meshes lead to nearly the same error."""

from dataclasses import dataclass
from statistics import mean, stdev

import numpy as np

from benchmarks.paper.curves import Panel, save_curves
from benchmarks.paper.methods import BOTH, PAPER_ITERATIONS
from benchmarks.paper.page import Check, Section, picture
from benchmarks.paper.related.counting import delaunay_mesh
from benchmarks.paper.sheet import drawn, save_sheet
from benchmarks.paper.study import Solution, Study
from benchmarks.timing import table
from stages.mesh import Mesh

HEADS = ("topology", "mean", "least", "most", "(most - least) / mean", "deviation / mean")
MOST_SPREAD = 0.015
"""Largest allowed difference between the runs, in means."""


@dataclass(frozen=True)
class RandomVertices:
    """Delaunay triangles over evenly drawn vertices.

    Source: Lawonn & Guenther (2018), Fig. 9.
    """

    vertices: int = 100
    """Number of vertices, the four corners included."""

    def build(self, pixels: np.ndarray, triangle_count: int, rng: np.random.Generator) -> Mesh:
        """Triangulate a picture [H, W, 3] uint8, whatever the wanted number of triangles."""
        size = np.array([pixels.shape[1], pixels.shape[0]])
        corners = size * np.array([[0, 0], [1, 0], [0, 1], [1, 1]])
        inner = 1.0 + rng.random((self.vertices - 4, 2)) * (size - 2.0)
        return delaunay_mesh(np.concatenate([corners, inner]), (int(size[0]), int(size[1])))


@dataclass(frozen=True)
class RandomStarts:
    """The same picture from many first meshes, as many iterations as the paper."""

    triangles: int = 1000
    starts: int = 10
    iterations: int = PAPER_ITERATIONS

    def run(self, study: Study) -> Section:
        """Solve the first picture from all starts, with both topologies."""
        rows, panels, cells, checks = [], [], [], []
        for method, make in BOTH:
            solutions = [
                study.watch(
                    study.first,
                    make().with_options(iterations=self.iterations),
                    self.triangles,
                    layout=RandomVertices(),
                    rng=np.random.default_rng([study.seed, start]),
                )
                for start in range(self.starts)
            ]
            study.say(f"  {method}: {self.starts} starts")
            errors = [solution.rmse for solution in solutions]
            spread = (max(errors) - min(errors)) / mean(errors)
            figures = [f"{f:.2f}" for f in (mean(errors), min(errors), max(errors))]
            rows.append((method, *figures, f"{spread:.2%}", f"{stdev(errors) / mean(errors):.2%}"))
            panels.append(_panel(method, solutions))
            cells += _ends(study, method, solutions)
            if method == "ours":
                checks.append(_check(spread, self.starts))
        save_curves(study.plots / "fig9_curves.png", panels)
        save_sheet(study.plots / "fig9.png", [cells])
        body = (
            f"{study.first}, {RandomVertices().vertices} random vertices, {self.triangles} "
            f"triangles, {self.iterations} iterations, constant colours, {self.starts} seeds. "
            f"rmse at the end:\n\n{table(HEADS, rows)}\n\n"
            f"{picture(study, 'fig9_curves.png', 'rmse against iterations')}\n\n"
            f"{picture(study, 'fig9.png', 'best and worst')}"
        )
        return Section("Fig. 9: random starts", body, tuple(checks))


def _panel(method: str, solutions: list[Solution]) -> Panel:
    """All runs in one pair of axes."""
    lines = {
        f"start {number}": ([m.iterations for m in s.moments], [m.rmse for m in s.moments])
        for number, s in enumerate(solutions)
    }
    return Panel(method, "iterations", "rmse", lines)


def _ends(study: Study, method: str, solutions: list[Solution]) -> list:
    """Pictures of the best and of the worst run."""
    ranked = sorted(solutions, key=lambda solution: solution.rmse)
    return [
        (drawn(study, s.snapshot, lines=True), f"{method}, {which}\nrmse {s.rmse:.2f}")
        for which, s in (("best", ranked[0]), ("worst", ranked[-1]))
    ]


def _check(spread: float, starts: int) -> Check:
    return Check(
        f"spread of {starts} random starts, (most - least) / mean",
        f"under {MOST_SPREAD:.1%}",
        f"{spread:.2%}",
        spread < MOST_SPREAD,
    )
