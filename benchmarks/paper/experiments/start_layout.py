"""Fig. 3: a regular grid against the picture's importance as first mesh."""

from dataclasses import dataclass

import numpy as np

from benchmarks.paper.curves import Panel, save_curves
from benchmarks.paper.methods import BOTH
from benchmarks.paper.page import Section, picture
from benchmarks.paper.sheet import drawn, save_sheet
from benchmarks.paper.study import Solution, Study
from benchmarks.timing import table
from stages.layouts import LAYOUTS
from stages.mesh import Mesh

STARTS = ("grid", "importance")
HEADS = (
    "picture",
    *(
        f"{method}, {start}: {what}"
        for method, _ in BOTH
        for start in STARTS
        for what in ("start", "end")
    ),
)


@dataclass(frozen=True)
class WholeLayout:
    """A layout that places all triangles, whatever part of them it is asked for."""

    name: str
    """Member of `LAYOUTS`."""
    triangles: int
    """All that there are to be."""

    def build(self, pixels: np.ndarray, triangle_count: int, rng: np.random.Generator) -> Mesh:
        """Triangulate a picture [H, W, 3] uint8."""
        return LAYOUTS[self.name]().build(pixels, self.triangles, rng)


@dataclass(frozen=True)
class StartLayout:
    """Two first meshes of as many triangles as there are to be: nothing is left to refine."""

    triangles: int = 700

    def run(self, study: Study) -> Section:
        """Solve every picture from both, with both topologies."""
        rows, shown = [], {}
        for name in study.pictures:
            row = [name]
            for method, make in BOTH:
                for start in STARTS:
                    layout = WholeLayout(start, self.triangles)
                    solution = study.watch(name, make(), self.triangles, layout=layout)
                    first = study.fit(
                        name, layout.build(study.pictures[name], 0, study.rng()), "constant"
                    )
                    row += [f"{first.rmse:.2f}", f"{solution.rmse:.2f}"]
                    if name == study.first:
                        shown[method, start] = (first, solution)
            rows.append(row)
        self._draw(study, shown)
        body = (
            f"{self.triangles} triangles from the start, constant colours, no refinement, as in "
            "the paper's figure; the paper's topology restores the Delaunay property for most "
            "of its iterations. rmse of the first mesh and of the last.\n\n"
            f"{table(HEADS, rows)}\n\n{picture(study, 'fig3.png', 'first and last meshes')}\n\n"
            f"{picture(study, 'fig3_curves.png', 'rmse against iterations')}"
        )
        return Section("Fig. 3: the first mesh", body)

    def _draw(self, study: Study, shown: dict[tuple[str, str], tuple]) -> None:
        """Sheet and curves of the first picture."""
        cells, lines = [], {}
        for (method, start), (first, solution) in shown.items():
            if method == "ours":
                cells.append((drawn(study, first, lines=True), f"{start}\nrmse {first.rmse:.1f}"))
                caption = f"{start}, optimised\nrmse {solution.rmse:.1f}"
                cells.append((drawn(study, solution.snapshot, lines=True), caption))
            lines[f"{method}, {start}"] = _curve(solution)
        save_sheet(study.plots / "fig3.png", [cells])
        panel = Panel(study.first, "iterations", "rmse", lines)
        save_curves(study.plots / "fig3_curves.png", [panel])


def _curve(solution: Solution) -> tuple[list[float], list[float]]:
    """Iterations and rmse."""
    return [m.iterations for m in solution.moments], [m.rmse for m in solution.moments]
